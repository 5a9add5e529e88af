#pragma once

#include <cstddef>
#include <string_view>

// Lines, words and numbers of the text parts of PLY and OBJ files. Safe on arbitrary bytes.

namespace fastccd::tools::detail {

/// Walks over the lines of a text; "\n" and "\r\n" both end a line, the last one may lack its end.
class LineCursor {
public:
    explicit LineCursor(std::string_view text) : text_(text) {}

    /// Moves to the next line and returns true, or returns false at the end of the text. Throws Interrupted after a signal.
    bool next();

    [[nodiscard]] std::string_view line() const { return line_; }  ///< without its end
    [[nodiscard]] std::size_t number() const { return number_; }   ///< of `line()`, from 1
    [[nodiscard]] std::size_t offset() const { return offset_; }   ///< of the first byte after it
    [[nodiscard]] std::string_view rest() const { return text_.substr(offset_); }

private:
    std::string_view text_;
    std::string_view line_;
    std::size_t number_ = 0;
    std::size_t offset_ = 0;
};

/// Takes the next blank-separated word off the front of `line`; empty when there is none.
std::string_view take_word(std::string_view& line);

/// Parses all of `word`, correctly rounded; a leading '+' is accepted, as are inf and nan. False
/// when it is not a number of type T or its magnitude overflows T. T: float, double, std::int64_t,
/// std::uint64_t.
template <class T>
bool parse_number(std::string_view word, T& value);

}  // namespace fastccd::tools::detail
