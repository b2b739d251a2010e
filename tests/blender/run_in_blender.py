# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests inside Blender's application, which has pytest as its Python does:

blender -b --factory-startup --python-exit-code 1 --python tests/blender/run_in_blender.py -- [pytest's arguments]
"""

import os
import sys

import pytest

here = os.path.dirname(os.path.abspath(__file__))
arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
status = int(pytest.main(["-p", "no:cacheprovider", "--rootdir", here, here, *arguments]))
sys.stdout.flush()
sys.stderr.flush()
# Not sys.exit: it runs the destructors of Blender's 300 libraries beside threads that still live, which can crash.
os._exit(status)
