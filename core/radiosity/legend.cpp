#include "radiosity/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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
constexpr int kBarWidth = 8, kBarHeight = 48;  // dots
constexpr int kMargin = 4;                     // dots
constexpr int kHeight = kBarHeight + 2 * kMargin + 2 * kLetterHeight + kMargin;
// Letters grow until it takes one part in so many of the picture's width or height; a dot is a pixel at least.
constexpr uint32_t kPartOfWidth = 8, kPartOfHeight = 4;

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
    std::vector<std::string> words;
    for (int step = 0; step <= kSteps; ++step) words.push_back(number(top * static_cast<float>(step) / kSteps));
    words.push_back(latin1(unit));
    size_t longest = 0;
    for (const std::string& word : words) longest = std::max(longest, word.size());
    const int words_at = 2 * kMargin + kBarWidth, width = words_at + static_cast<int>(longest) * kLetterWidth + kMargin;

    const Window& window = film.window();
    const auto across = static_cast<uint32_t>(width), up = static_cast<uint32_t>(kHeight);
    if (2 * window.width < 3 * across || 2 * window.height < 3 * up) return false;
    const auto dot = static_cast<int>(
        std::max(std::min(window.width / (kPartOfWidth * across), window.height / (kPartOfHeight * up)), 1u));
    const int left = static_cast<int>(window.width) - dot * (width + kMargin), bottom = dot * kMargin;
    const int x0 = std::max(left, static_cast<int>(window.x)), y0 = std::max(bottom, static_cast<int>(window.y)),
              x1 = std::min(left + dot * width, static_cast<int>(window.x + window.w)),
              y1 = std::min(bottom + dot * kHeight, static_cast<int>(window.y + window.h));
    if (x0 >= x1 || y0 >= y1) return false;
    tile.x = static_cast<uint32_t>(x0), tile.y = static_cast<uint32_t>(y0);
    tile.width = static_cast<uint32_t>(x1 - x0), tile.height = static_cast<uint32_t>(y1 - y0);

    const auto fill = [&](int x, int y, int w, int h, const Vec3& color) {
        for (int py = std::max(bottom + dot * y, y0); py < std::min(bottom + dot * (y + h), y1); ++py)
            for (int px = std::max(left + dot * x, x0); px < std::min(left + dot * (x + w), x1); ++px)
                film.paint(static_cast<uint32_t>(px), static_cast<uint32_t>(py), color);
    };
    const auto ink = [&](int x, int y) { fill(x, y, 1, 1, {1, 1, 1}); };
    fill(0, 0, width, kHeight, {0.01f, 0.01f, 0.01f});
    const int bar_bottom = kMargin + kLetterHeight / 2;
    for (int y = 0; y < kBarHeight; ++y)
        fill(kMargin, bar_bottom + y, kBarWidth, 1,
             false_color((static_cast<float>(y) + 0.5f) / static_cast<float>(kBarHeight)));
    for (int step = 0; step <= kSteps; ++step)
        write(words[static_cast<size_t>(step)], words_at, kMargin + step * kBarHeight / kSteps, ink);
    write(words.back(), words_at, kHeight - kMargin - kLetterHeight, ink);
    return true;
}

}  // namespace trp
