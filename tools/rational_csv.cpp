#include "rational_csv.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "input_error.hpp"
#include "interrupt.hpp"
#include "mapped_file.hpp"
#include "rational.hpp"
#include "shown_text.hpp"

namespace fastccd::tools {
namespace {

constexpr std::size_t rows_per_pair = 8;
constexpr std::size_t coordinate_columns = 6;
constexpr std::size_t most_columns = coordinate_columns + 1;
constexpr std::size_t most_digits = 1'000'000;  ///< In lowest terms no double has more than 324. GMP ends the program when memory does.
constexpr std::size_t least_row = 2 * coordinate_columns;  ///< Bytes: digits, commas and a newline.

constexpr std::array<std::string_view, most_columns> column_names{
    "x numerator", "x denominator", "y numerator", "y denominator", "z numerator", "z denominator", "truth"};

std::string_view trim(std::string_view text)
{
    constexpr std::string_view blanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

class Parser {
public:
    Parser(std::string_view text, const std::filesystem::path& path, Rounding rounding)
        : path_{path}, rounding_{rounding}
    {
        // Spreadsheets put this in front of UTF-8.
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
        // Blank lines after the last row are an editor's, not a pair's.
        const std::size_t last = text.find_last_not_of(" \t\r\n");
        rest_ = text.substr(0, last == std::string_view::npos ? 0 : last + 1);
    }

    RationalCsv parse()
    {
        const std::size_t rows =
            rest_.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n'));
        // No more than there is text for: blank lines without end are to be refused with their row, not for want of memory.
        const std::size_t most_rows = (rest_.size() + 1) / least_row;
        RationalCsv result{PairBuffer{std::min(rows, most_rows) / rows_per_pair}, {}};
        for (row_ = 1; row_ <= rows; ++row_) {
            if (row_ % 65536 == 0) check_interrupt();
            split(next_line());
            const std::size_t pair = (row_ - 1) / rows_per_pair;
            const std::size_t point = (row_ - 1) % rows_per_pair;
            check_shape();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double value = rational(2 * axis);
                // The rows left over when the file stops within a pair have no place in the buffer.
                if (pair < result.pairs.size()) result.pairs.at(pair, 3 * point + axis) = value;
            }
            if (columns_ == most_columns) read_truth(point, result.truth);
        }
        if (rows % rows_per_pair != 0) {
            throw InputError(path_, fmt::format("ends after row {}, within a pair: a pair takes {} rows", rows,
                                                rows_per_pair));
        }
        return result;
    }

private:
    std::string_view next_line()
    {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return line;
    }

    void split(std::string_view line)
    {
        columns_ = 0;
        for (bool more = true; more; ++columns_) {
            const std::size_t comma = line.find(',');
            more = comma != std::string_view::npos;
            if (columns_ < most_columns) fields_[columns_] = trim(line.substr(0, comma));
            if (more) line.remove_prefix(comma + 1);
        }
        if (columns_ == 1 && fields_[0].empty()) columns_ = 0;
    }

    void check_shape()
    {
        if (columns_ != coordinate_columns && columns_ != most_columns) {
            fail(fmt::format("has {} column{}; expected {}, or {} with the truth", columns_, columns_ == 1 ? "" : "s",
                             coordinate_columns, most_columns));
        }
        if (row_ == 1) first_columns_ = columns_;
        if (columns_ != first_columns_) {
            fail(columns_ == most_columns ? "has a truth column, which the rows before it have not"
                                          : "lacks the truth column that the rows before it have");
        }
    }

    double rational(std::size_t column) const
    {
        for (const std::size_t c : {column, column + 1}) {
            if (!is_integer(fields_[c])) fail(c, fmt::format("{} is not an integer", in_quotes(fields_[c])));
            if (fields_[c].size() > most_digits) fail(c, fmt::format("{} digits; at most {} are read", fields_[c].size(), most_digits));
        }
        const RationalValue result = rational_to_double(fields_[column], fields_[column + 1]);
        const auto fraction = [&] { return fmt::format("{}/{}", shown(fields_[column]), shown(fields_[column + 1])); };
        switch (result.conversion) {
        case Conversion::exact: break;
        case Conversion::rounded:
            if (rounding_ == Rounding::exact_only) {
                fail(column, fmt::format("{} is not a double; use --round to take the nearest one", fraction()));
            }
            break;
        case Conversion::overflow: fail(column, fmt::format("{} is beyond the range of double", fraction()));
        case Conversion::zero_denominator: fail(column + 1, "the denominator is zero");
        }
        return result.value;
    }

    void read_truth(std::size_t point, std::vector<std::int8_t>& truth) const
    {
        constexpr std::size_t column = coordinate_columns;
        const std::string_view field = fields_[column];
        if (field != "0" && field != "1") fail(column, fmt::format("{} is neither 0 nor 1", in_quotes(field)));
        const auto value = static_cast<std::int8_t>(field == "1");
        if (point == 0) {
            truth.push_back(value);
        } else if (truth.back() != value) {
            fail(column, fmt::format("is {}, but the first row of the same pair, row {}, says {}", value, row_ - point,
                                     truth.back()));
        }
    }

    [[noreturn]] void fail(std::string_view what) const
    {
        throw InputError(path_, fmt::format("row {} {}", row_, what));
    }

    [[noreturn]] void fail(std::size_t column, std::string_view what) const
    {
        throw InputError(path_, fmt::format("row {}, column {} ({}): {}", row_, column + 1, column_names[column], what));
    }

    const std::filesystem::path& path_;
    Rounding rounding_;
    std::string_view rest_;
    std::size_t row_ = 1;
    std::size_t columns_ = 0;  // of the current row; past most_columns only counted
    std::size_t first_columns_ = 0;
    std::array<std::string_view, most_columns> fields_;
};

}  // namespace

RationalCsv parse_rational_csv(std::string_view text, const std::filesystem::path& path, Rounding rounding)
{
    return Parser{text, path, rounding}.parse();
}

RationalCsv read_rational_csv(const std::filesystem::path& path, Rounding rounding)
{
    const MappedFile file{path};
    file.load(0, file.bytes().size());
    return file.parsed([&](std::string_view text) { return parse_rational_csv(text, path, rounding); });
}

}  // namespace fastccd::tools
