// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: what the readers of text formats share.

#include <cstdint>
#include <string>
#include <string_view>

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Splits a text into lines and words without copying it, and reads numbers with errors that name file and line.
///
/// Lines end with LF, CRLF or CR. A backslash as the last character of a line joins the next one to it, but not in
/// comments (a path at the end of one would swallow data). `#` begins a comment wherever it stands. Words are
/// parted by blanks; every other byte, zero included, is part of a word. A UTF-8 byte-order mark is skipped.
class LineScanner {
public:
    /// `text` must outlive the scanner.
    LineScanner(std::string_view text, std::string fileName);

    /// Goes to the next line that has a word; false at the end of the text.
    bool NextLine();

    /// The next word of this line; empty at its end.
    std::string_view NextWord();

    /// The line on which this (perhaps continued) line begins, from 1; after the end: the last line of the text.
    std::int64_t Line() const { return _firstLine; }
    std::string const& FileName() const { return _fileName; }

    /// The number that `word` spells, not only begins with: decimals, exponents, "inf" and "nan"; too large is
    /// infinite, too small 0. `what` names the place in the error: "v takes three numbers".
    double Number(std::string_view word, std::string_view what) const;

    /// The whole number that `word` spells; ones that don't fit are an error as well.
    std::int64_t Integer(std::string_view word, std::string_view what) const;

    /// `Number`, which must be 0 or more; 10 and more, infinite included, gives 10, OpenSubdiv's infinite.
    float Sharpness(std::string_view word, std::string_view what) const;

    /// Throws ParseError for this line.
    [[noreturn]] void Fail(std::string const& text) const;

    /// "FILE:LINE: text" of this line.
    std::string Locate(std::string const& text) const;

private:
    bool skipBlanks();
    void skipLineEnd();

    char const* _at;
    char const* _end;
    std::int64_t _line = 1;
    std::int64_t _firstLine = 1;
    bool _started = false;
    std::string _fileName;
};

/// Parses the whole number at the front of [`at`, `end`) and returns where it ends; `at` when there is none.
/// Saturates, so that callers see numbers that are far out of range as such.
char const* ParseInteger(char const* at, char const* end, std::int64_t& value);

/// `word` in quotes for a message: shortened, and with everything unprintable escaped.
std::string Quote(std::string_view word);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
