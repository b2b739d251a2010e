#include "radiosity/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace trp {
namespace {

// Letters of 5 × 7 dots, a number to each row from the top, its lowest bit to the right. Latin-1.
struct Letter {
    char letter;
    uint8_t rows[7];
};
constexpr Letter kLetters[] = {
    {'0', {0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E}}, {'1', {0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E}},
    {'2', {0x0E, 0x11, 0x01, 0x06, 0x08, 0x10, 0x1F}}, {'3', {0x0E, 0x11, 0x01, 0x06, 0x01, 0x11, 0x0E}},
    {'4', {0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02}}, {'5', {0x1F, 0x10, 0x1E, 0x01, 0x01, 0x11, 0x0E}},
    {'6', {0x06, 0x08, 0x10, 0x1E, 0x11, 0x11, 0x0E}}, {'7', {0x1F, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0E, 0x11, 0x11, 0x0E, 0x11, 0x11, 0x0E}}, {'9', {0x0E, 0x11, 0x11, 0x0F, 0x01, 0x02, 0x0C}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0C, 0x0C}}, {'-', {0x00, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x00}},
    {'+', {0x00, 0x04, 0x04, 0x1F, 0x04, 0x04, 0x00}}, {'e', {0x00, 0x00, 0x0E, 0x11, 0x1F, 0x10, 0x0E}},
    {'W', {0x11, 0x11, 0x11, 0x15, 0x15, 0x15, 0x0A}}, {'/', {0x01, 0x01, 0x02, 0x04, 0x08, 0x10, 0x10}},
    {'m', {0x00, 0x00, 0x1A, 0x15, 0x15, 0x15, 0x15}}, {'\xB2', {0x0C, 0x12, 0x04, 0x08, 0x1E, 0x00, 0x00}},
    {'l', {0x0C, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0E}}, {'u', {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0D}},
    {'x', {0x00, 0x00, 0x11, 0x0A, 0x04, 0x0A, 0x11}}, {'F', {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x10}},
};
constexpr int kLetterWidth = 6, kLetterHeight = 7;  // dots, with a gap to the next

constexpr int kSteps = 4;                      // of colours, with a number at the end of each
constexpr int kBarWidth = 8, kBarHeight = 96;  // dots
constexpr int kMargin = 5, kWords = 8;         // dots; letters that numbers may take
constexpr int kWidth = 3 * kMargin + kBarWidth + kWords * kLetterWidth,
              kHeight = kBarHeight + 2 * kMargin + 2 * kLetterHeight + kMargin;

// Draws words so that their lower left corner lies at a dot, through put(dot across, dot up).
template <class Put>
void write(const std::string& words, int x, int y, Put&& put) {
    for (size_t k = 0; k < words.size(); ++k) {
        const auto* letter = std::find_if(std::begin(kLetters), std::end(kLetters),
                                          [&](const Letter& l) { return l.letter == words[k]; });
        if (letter == std::end(kLetters)) continue;
        for (int row = 0; row < kLetterHeight; ++row)
            for (int column = 0; column < kLetterWidth - 1; ++column)
                if (letter->rows[row] >> (kLetterWidth - 2 - column) & 1)
                    put(x + static_cast<int>(k) * kLetterWidth + column, y + kLetterHeight - 1 - row);
    }
}

std::string number(float value) {
    return value >= 1000 && value < 1e7f ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string latin1(std::string text) {
    const std::string square = "\xC2\xB2";  // ² in UTF-8
    if (const size_t at = text.find(square); at != std::string::npos) text.erase(at, 1);
    return text;
}

}  // namespace

Vec3 false_color(float share) {
    static constexpr float kStops[kSteps + 1][3] = {{0, 0, 1}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    const float at = kSteps * std::clamp(share, 0.0f, 1.0f);
    const int step = std::min(static_cast<int>(at), kSteps - 1);
    Vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = std::lerp(kStops[step][c], kStops[step + 1][c], at - static_cast<float>(step));
    return out;
}

bool draw_legend(Film& film, float top, const char* unit, TrpTile& tile) {
    const Window& window = film.window();
    const auto dot = static_cast<int>(std::min(window.width / (3 * kWidth), window.height / (3 * kHeight / 2)));
    if (dot < 1) return false;
    const int left = static_cast<int>(window.width) - dot * (kWidth + kMargin), bottom = dot * kMargin;
    const int x0 = std::max(left, static_cast<int>(window.x)), y0 = std::max(bottom, static_cast<int>(window.y)),
              x1 = std::min(left + dot * kWidth, static_cast<int>(window.x + window.w)),
              y1 = std::min(bottom + dot * kHeight, static_cast<int>(window.y + window.h));
    if (x0 >= x1 || y0 >= y1) return false;
    tile.x = static_cast<uint32_t>(x0), tile.y = static_cast<uint32_t>(y0);
    tile.width = static_cast<uint32_t>(x1 - x0), tile.height = static_cast<uint32_t>(y1 - y0);

    const auto fill = [&](int x, int y, int width, int height, const Vec3& color) {
        for (int py = std::max(bottom + dot * y, y0); py < std::min(bottom + dot * (y + height), y1); ++py)
            for (int px = std::max(left + dot * x, x0); px < std::min(left + dot * (x + width), x1); ++px)
                film.paint(static_cast<uint32_t>(px), static_cast<uint32_t>(py), color);
    };
    const auto ink = [&](int x, int y) { fill(x, y, 1, 1, {1, 1, 1}); };
    fill(0, 0, kWidth, kHeight, {0.01f, 0.01f, 0.01f});
    const int bar_bottom = kMargin + kLetterHeight / 2;
    for (int y = 0; y < kBarHeight; ++y)
        fill(kMargin, bar_bottom + y, kBarWidth, 1,
             false_color((static_cast<float>(y) + 0.5f) / static_cast<float>(kBarHeight)));
    const int words = 2 * kMargin + kBarWidth;
    for (int step = 0; step <= kSteps; ++step)
        write(number(top * static_cast<float>(step) / kSteps), words, kMargin + step * kBarHeight / kSteps, ink);
    write(latin1(unit), words, kHeight - kMargin - kLetterHeight, ink);
    return true;
}

}  // namespace trp
