#include "mesh_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <type_traits>

#include "../interrupt.hpp"

namespace fastccd::tools::detail {

bool LineCursor::next()
{
    if (offset_ == text_.size()) return false;
    const std::size_t end = text_.find('\n', offset_);
    line_ = text_.substr(offset_, end == std::string_view::npos ? end : end - offset_);
    offset_ = end == std::string_view::npos ? text_.size() : end + 1;
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    if (++number_ % 65536 == 0) check_interrupt();
    return true;
}

std::string_view take_word(std::string_view& line)
{
    constexpr std::string_view blanks = " \t\r\v\f";
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos) {
        line = {};
        return {};
    }
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

template <class T>
bool parse_number(std::string_view word, T& value)
{
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end) return false;
    if (error == std::errc()) return true;
    if constexpr (std::is_floating_point_v<T>) {
        if (error == std::errc::result_out_of_range) {
            // from_chars reports overflow and underflow alike. What underflows rounds to zero; the
            // wider type tells which it was.
            long double wide = 0;
            if (std::from_chars(word.data(), end, wide).ec == std::errc() && std::fabs(wide) < 1) {
                value = std::signbit(wide) ? -T(0) : T(0);
                return true;
            }
        }
    }
    return false;
}

template bool parse_number(std::string_view, float&);
template bool parse_number(std::string_view, double&);
template bool parse_number(std::string_view, std::int64_t&);
template bool parse_number(std::string_view, std::uint64_t&);

}  // namespace fastccd::tools::detail
