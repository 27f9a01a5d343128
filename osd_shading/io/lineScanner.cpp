// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/lineScanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

enum CharKind : unsigned char { kWord, kBlank, kLineEnd, kComment, kBackslash };

constexpr std::array<CharKind, 256> kCharKinds = [] {
    std::array<CharKind, 256> kinds{};
    for (char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = kBlank;
    for (char c : {'\n', '\r'}) kinds[static_cast<unsigned char>(c)] = kLineEnd;
    kinds['#'] = kComment;
    kinds['\\'] = kBackslash;
    return kinds;
}();

CharKind kindOf(char c) { return kCharKinds[static_cast<unsigned char>(c)]; }

bool joinsLines(char const* at, char const* end) {
    return *at == '\\' && (at + 1 == end || kindOf(at[1]) == kLineEnd);
}

// What from_chars reports as out of range is too large or too small; the place of the first digit tells which.
bool isTooLarge(char const* at, char const* end) {
    std::int64_t place = 0;
    bool afterPoint = false, started = false;
    for (; at != end && *at != 'e' && *at != 'E'; ++at) {
        if (*at == '.') afterPoint = true;
        if (*at < '0' || *at > '9') continue;
        if (!afterPoint && (started || *at != '0')) ++place;
        if (afterPoint && !started && *at == '0') --place;
        started = started || *at != '0';
    }
    if (!started) return false;
    std::int64_t exponent = 0;
    if (at != end) {
        ++at;
        ParseInteger(at, end, exponent);
    }
    // Both are far from overflow: a text has no 2^62 digits, and the exponent counts only up to there.
    constexpr std::int64_t kFar = std::int64_t{1} << 62;
    return place + std::clamp(exponent, -kFar, kFar) > 0;
}

}  // namespace

char const* ParseInteger(char const* at, char const* end, std::int64_t& value) {
    // from_chars takes no plus sign; "+-1" stays no number.
    char const* const digits = at != end && *at == '+' && at + 1 != end && at[1] != '-' ? at + 1 : at;
    auto const result = std::from_chars(digits, end, value);
    if (result.ec == std::errc::result_out_of_range) {
        value =
            *digits == '-' ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
    }
    return result.ec == std::errc::invalid_argument ? at : result.ptr;
}

std::string Quote(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string quoted = "'";
    for (char c : word.substr(0, kLongest)) {
        if (c >= 0x20 && c < 0x7f) {
            quoted += c;
        } else {
            constexpr char kDigits[] = "0123456789abcdef";
            auto const byte = static_cast<unsigned char>(c);
            quoted += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
        }
    }
    return quoted + (word.size() > kLongest ? "...'" : "'");
}

LineScanner::LineScanner(std::string_view text, std::string fileName)
    : _at(text.data()), _end(text.data() + text.size()), _fileName(std::move(fileName)) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") _at += 3;
}

void LineScanner::skipLineEnd() {
    if (_at[0] == '\r' && _at + 1 != _end && _at[1] == '\n') ++_at;
    ++_at;
    ++_line;
}

// Leaves _at on a word, true, or on the line's end, false.
bool LineScanner::skipBlanks() {
    while (_at != _end) {
        switch (kindOf(*_at)) {
            case kBlank:
                ++_at;
                break;
            case kLineEnd:
                return false;
            case kComment:
                while (_at != _end && kindOf(*_at) != kLineEnd) ++_at;
                return false;
            case kBackslash:
                if (!joinsLines(_at, _end)) return true;
                ++_at;
                if (_at != _end) skipLineEnd();
                break;
            case kWord:
                return true;
        }
    }
    return false;
}

bool LineScanner::NextLine() {
    if (!_started) {
        _started = true;
        if (skipBlanks()) return true;
    }
    while (!NextWord().empty()) {
    }
    while (_at != _end) {
        skipLineEnd();
        _firstLine = _line;
        if (skipBlanks()) return true;
    }
    return false;
}

std::string_view LineScanner::NextWord() {
    if (!skipBlanks()) return {};
    char const* const begin = _at;
    for (; _at != _end; ++_at) {
        CharKind const kind = kindOf(*_at);
        if (kind == kWord || (kind == kBackslash && !joinsLines(_at, _end))) continue;
        break;
    }
    return {begin, static_cast<std::size_t>(_at - begin)};
}

double LineScanner::Number(std::string_view word, std::string_view what) const {
    char const* at = word.data();
    char const* const end = at + word.size();
    if (word.size() > 1 && *at == '+' && at[1] != '-') ++at;
    double value = 0;
    auto const result = std::from_chars(at, end, value);
    if (result.ec == std::errc::invalid_argument || result.ptr != end) {
        Fail(Quote(word) + " is not a number: " + std::string(what));
    }
    if (result.ec == std::errc::result_out_of_range) {
        value = isTooLarge(at, end) ? std::numeric_limits<double>::infinity() : 0.0;
        if (*at == '-') value = -value;
    }
    return value;
}

std::int64_t LineScanner::Integer(std::string_view word, std::string_view what) const {
    std::int64_t value = 0;
    char const* const end = word.data() + word.size();
    if (word.empty() || ParseInteger(word.data(), end, value) != end) {
        Fail(Quote(word) + " is not a whole number: " + std::string(what));
    }
    return value;
}

float LineScanner::Sharpness(std::string_view word, std::string_view what) const {
    double const value = Number(word, what);
    if (!(value >= 0)) {
        Fail("sharpness " + Quote(word) + " is " + (std::isnan(value) ? "not a number" : "negative") +
             ": give 0 (smooth) to 10 (infinite)");
    }
    return static_cast<float>(std::min(value, double{kInfiniteSharpness}));
}

void LineScanner::Fail(std::string const& text) const { throw ParseError(_fileName, _firstLine, text); }

std::string LineScanner::Locate(std::string const& text) const {
    return _fileName + ":" + std::to_string(_firstLine) + ": " + text;
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
