// False colours, and the scale that says what they mean.
#pragma once

#include "film/film.h"
#include "triptych/triptych.h"

namespace trp {

// Blue, cyan, green, yellow and red in equal steps, from 0 to 1.
Vec3 false_color(float share);

// Draws the colours from 0 to `top` into the right of the picture, with numbers and their unit beside them, where the
// film shows that part; `tile` becomes the part's window. Returns false where it shows none of it, or where the picture
// is too small for words.
bool draw_legend(Film& film, float top, const char* unit, TrpTile& tile);

}  // namespace trp
