# SPDX-License-Identifier: GPL-3.0-or-later
"""The gallery (gallery.py) with at most 10,000 faces."""

from gallery import build_gallery


def build():
    build_gallery(0.32)
