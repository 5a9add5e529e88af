// The rational CSV reader: exact conversion, correct rounding, every malformed file named by row.
#include "rational_csv.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmp.h>
#include <gtest/gtest.h>

#include "input_error.hpp"
#include "rational.hpp"

namespace fastccd::tools {
namespace {

/// `rows` rows of distinct small coordinates.
std::vector<std::string> plain_rows(std::size_t rows, const std::string& tail = "")
{
    std::vector<std::string> text;
    for (std::size_t i = 0; i < rows; ++i) {
        text.push_back(std::to_string(i) + ",1,-" + std::to_string(2 * i + 1) + ",4,3,2" + tail);
    }
    return text;
}

std::string join(const std::vector<std::string>& rows, const std::string& newline = "\n")
{
    std::string text;
    for (const std::string& row : rows) text += row + newline;
    return text;
}

/// Eight plain rows, of which row `row` (from 1) is `text`.
std::string with_row(std::size_t row, const std::string& text, const std::string& tail = "")
{
    std::vector<std::string> rows = plain_rows(8, tail);
    rows.at(row - 1) = text;
    return join(rows);
}

RationalCsv parse(const std::string& text, Rounding rounding = Rounding::exact_only)
{
    return parse_rational_csv(text, "queries/a.csv", rounding);
}

void expect_plain(const RationalCsv& csv, std::size_t pairs)
{
    ASSERT_EQ(csv.pairs.size(), pairs);
    for (std::size_t i = 0; i < 8 * pairs; ++i) {
        const auto row = static_cast<double>(i);
        EXPECT_EQ(csv.pairs.at(i / 8, 3 * (i % 8)), row);
        EXPECT_EQ(csv.pairs.at(i / 8, 3 * (i % 8) + 1), -(2 * row + 1) / 4);
        EXPECT_EQ(csv.pairs.at(i / 8, 3 * (i % 8) + 2), 1.5);
    }
}

TEST(RationalCsv, ReadsWithAndWithoutTruth)
{
    const RationalCsv bare = parse(join(plain_rows(16)));
    expect_plain(bare, 2);
    EXPECT_TRUE(bare.truth.empty());

    std::vector<std::string> rows = plain_rows(8, ",1");
    for (std::size_t i = 8; i < 16; ++i) rows.push_back(plain_rows(16, ",0")[i]);
    const RationalCsv known = parse(join(rows));
    expect_plain(known, 2);
    EXPECT_EQ(known.truth, (std::vector<std::int8_t>{1, 0}));
}

TEST(RationalCsv, LineEndsAndBlanksDoNotMatter)
{
    const std::string unix_text = join(plain_rows(8));
    expect_plain(parse(join(plain_rows(8), "\r\n")), 1);
    expect_plain(parse(unix_text.substr(0, unix_text.size() - 1)), 1);
    expect_plain(parse(unix_text + "\n \r\n\n"), 1);
    expect_plain(parse("\xEF\xBB\xBF" + unix_text), 1);
    EXPECT_EQ(parse(with_row(2, " +1 ,\t1, -3 ,4,3 , 2 ")).pairs.at(0, 4), -0.75);
}

TEST(RationalCsv, NoRowsAreNoPairs)
{
    for (const char* text : {"", "\n", "\r\n\r\n"}) EXPECT_EQ(parse(text).pairs.size(), 0U);
}

TEST(RationalCsv, RoundsOnlyWhenTold)
{
    const std::string text = with_row(3, "1,3,1,1,1,1");
    EXPECT_THROW((void)parse(text), InputError);
    EXPECT_EQ(parse(text, Rounding::nearest).pairs.at(0, 6), 1.0 / 3.0);
}

struct Malformed {
    const char* name;
    std::string text;
    const char* message;
};

class RationalCsvMalformed : public testing::TestWithParam<Malformed> {};

TEST_P(RationalCsvMalformed, IsRefusedByRow)
{
    try {
        (void)parse(GetParam().text);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.find("queries/a.csv: "), 0U) << what;
        EXPECT_NE(what.find(GetParam().message), std::string::npos) << what;
        for (const char c : what) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << what;
    }
}

std::vector<Malformed> malformed_files()
{
    const std::string beyond_double = "1" + std::string(309, '0');
    std::vector<std::string> late_truth = plain_rows(16, ",1");
    late_truth[12] = plain_rows(16, ",0")[12];
    return {
        {"three_rows", join(plain_rows(3)), "ends after row 3, within a pair"},
        {"nine_rows", join(plain_rows(9)), "ends after row 9"},
        {"header_line", "x,y,z\n" + join(plain_rows(8)), "row 1 has 3 columns"},
        {"header_of_six", "xn,xd,yn,yd,zn,zd\n" + join(plain_rows(8)), "row 1, column 1 (x numerator): 'xn' is not"},
        {"five_columns", with_row(2, "1,1,1,1,1"), "row 2 has 5 columns"},
        {"one_column", with_row(2, "1"), "row 2 has 1 column;"},
        {"eight_columns", with_row(8, "1,1,1,1,1,1,1,1"), "row 8 has 8 columns"},
        {"many_columns", with_row(5, std::string(100'000, ',')), "row 5 has 100001 columns"},
        {"blank_row", with_row(4, ""), "row 4 has 0 columns"},
        {"digits_without_end", with_row(4, "1,1,1," + std::string(1'000'001, '1') + ",1,1"),
         "row 4, column 4 (y denominator): 1000001 digits; at most"},
        {"decimal_point", with_row(4, "1,1,0.5,1,1,1"), "row 4, column 3 (y numerator): '0.5' is not an integer"},
        {"exponent", with_row(4, "1,1,1,1,1e5,1"), "row 4, column 5 (z numerator)"},
        {"not_a_number", with_row(4, "nan,1,1,1,1,1"), "row 4, column 1"},
        {"hexadecimal", with_row(4, "0x10,1,1,1,1,1"), "row 4, column 1"},
        {"empty_field", with_row(4, "1,1,,1,1,1"), "row 4, column 3 (y numerator): '' is not"},
        {"sign_only", with_row(4, "1,1,-,1,1,1"), "row 4, column 3"},
        {"two_signs", with_row(4, "1,1,--1,1,1,1"), "row 4, column 3"},
        {"blank_inside", with_row(4, "1,1,1 2,1,1,1"), "row 4, column 3"},
        {"zero_byte", with_row(4, std::string("1,1,1\0,1,1,1", 12)), "row 4, column 3 (y numerator): '1\\x00'"},
        {"not_ascii", with_row(4, "1,1,\xe2\x88\x92" "1,1,1,1"), "row 4, column 3 (y numerator): '\\xe2\\x88\\x921'"},
        {"semicolons", with_row(1, "1;1;1;1;1;1"), "row 1 has 1 column;"},
        {"zero_denominator", with_row(6, "1,1,1,1,1,0"), "row 6, column 6 (z denominator): the denominator is zero"},
        {"zero_over_zero", with_row(6, "0,000,1,1,1,1"), "row 6, column 2"},
        {"no_double", with_row(7, "1,1,1,10,1,1"), "row 7, column 3 (y numerator): 1/10 is not a double"},
        {"beyond_double", with_row(7, beyond_double + ",1,1,1,1,1"), "beyond the range of double"},
        {"truth_missing", with_row(5, "1,1,1,1,1,1", ",1"), "row 5 lacks the truth column"},
        {"truth_in_addition", with_row(5, "1,1,1,1,1,1,1"), "row 5 has a truth column"},
        {"truth_of_two", with_row(5, "1,1,1,1,1,1,2", ",1"), "row 5, column 7 (truth): '2' is neither 0 nor 1"},
        {"truth_empty", with_row(5, "1,1,1,1,1,1,", ",1"), "row 5, column 7 (truth): '' is neither"},
        {"truth_at_odds", join(late_truth), "row 13, column 7 (truth): is 0, but the first row of the same pair, row 9"},
    };
}

INSTANTIATE_TEST_SUITE_P(Table, RationalCsvMalformed, testing::ValuesIn(malformed_files()),
                         [](const auto& test) { return std::string{test.param.name}; });

TEST(RationalCsv, RandomDamageIsAcceptedOrNamedNeverWorse)
{
    const std::string good = join(plain_rows(16, ",1"));
    const std::string bytes = "0123456789,,,--+\n\n\r .e\0x/\xff";
    std::mt19937 random{1};
    const auto below = [&random](std::size_t n) { return std::uniform_int_distribution<std::size_t>{0, n - 1}(random); };
    for (int i = 0; i < 20'000; ++i) {
        std::string text = good;
        for (std::size_t k = 0; k <= below(4); ++k) text[below(text.size())] = bytes[below(bytes.size())];
        if (below(4) == 0) text.resize(below(text.size()));
        for (const Rounding rounding : {Rounding::exact_only, Rounding::nearest}) {
            try {
                const RationalCsv csv = parse(text, rounding);
                EXPECT_TRUE(csv.truth.empty() || csv.truth.size() == csv.pairs.size());
            } catch (const InputError&) {
            }
        }
    }
}

// ---- Conversion -------------------------------------------------------------------------------------------

/// 2^exponent in decimal.
std::string power_of_two(unsigned exponent)
{
    mpz_t value;
    mpz_init(value);
    mpz_ui_pow_ui(value, 2, exponent);
    std::string text(mpz_sizeinbase(value, 10) + 2, '\0');
    mpz_get_str(text.data(), 10, value);
    text.resize(text.find('\0'));
    mpz_clear(value);
    return text;
}

TEST(Rational, ExtremesConvert)
{
    using Limits = std::numeric_limits<double>;
    const auto check = [](const std::string& n, const std::string& d, double value, Conversion conversion) {
        SCOPED_TRACE(n + " / " + d);
        const RationalValue result = rational_to_double(n, d);
        EXPECT_EQ(result.value, value);
        EXPECT_EQ(result.conversion, conversion);
    };
    check("0", "5", 0.0, Conversion::exact);
    check("-0", power_of_two(3000), 0.0, Conversion::exact);
    check("6", "-4", -1.5, Conversion::exact);
    check("-6", "-4", 1.5, Conversion::exact);
    check("0006", "04", 1.5, Conversion::exact);
    check("9007199254740993", "1", 9007199254740992.0, Conversion::rounded);   // tie, to even: down
    check("9007199254740995", "1", 9007199254740996.0, Conversion::rounded);   // tie, to even: up
    check("18014398509481989", "2", 9007199254740994.0, Conversion::rounded);  // 2^53 + 2.5: no tie
    check("18446744073709551615", "1", 0x1p64, Conversion::rounded);
    check(power_of_two(1023), "1", 0x1p1023, Conversion::exact);
    check(power_of_two(1024), "1", Limits::infinity(), Conversion::overflow);
    check(power_of_two(5000), power_of_two(4000), 0x1p1000, Conversion::exact);
    check("1", power_of_two(1022), Limits::min(), Conversion::exact);
    check("1", power_of_two(1074), Limits::denorm_min(), Conversion::exact);
    check("1", power_of_two(1075), 0.0, Conversion::rounded);  // tie, to even
    check("3", power_of_two(1076), Limits::denorm_min(), Conversion::rounded);
    check("1", power_of_two(1076), 0.0, Conversion::rounded);
    check("1", power_of_two(100'000), 0.0, Conversion::rounded);
    check(power_of_two(100'000), "3", Limits::infinity(), Conversion::overflow);
    // Half a unit in the last place below 2^1024 rounds up, out of range.
    EXPECT_EQ(rational_to_double("1797693134862315807" + std::string(290, '9'), "1").conversion, Conversion::overflow);
    EXPECT_EQ(rational_to_double("1", "-0").conversion, Conversion::zero_denominator);
}

/// |numerator / denominator - x| as a rational, compared: <0, 0, >0.
int compare_distance(const mpq_t exact, double x, double y)
{
    mpq_t dx;
    mpq_t dy;
    mpq_inits(dx, dy, nullptr);
    mpq_set_d(dx, x);
    mpq_set_d(dy, y);
    mpq_sub(dx, exact, dx);
    mpq_sub(dy, exact, dy);
    mpq_abs(dx, dx);
    mpq_abs(dy, dy);
    const int order = mpq_cmp(dx, dy);
    mpq_clears(dx, dy, nullptr);
    return order;
}

TEST(Rational, IsTheNearestDoubleTiesToEven)
{
    std::mt19937_64 random{7};
    const auto digits = [&random](std::size_t n) {
        std::string text(1, static_cast<char>('1' + random() % 9));
        while (text.size() < n) text += static_cast<char>('0' + random() % 10);
        return text;
    };
    mpq_t exact;
    mpq_t back;
    mpq_inits(exact, back, nullptr);
    for (int i = 0; i < 20'000; ++i) {
        // Up to 340 digits below the line: subnormal results too. Now and then a power of two, so
        // that ties and exact results occur.
        std::string n = digits(1 + random() % 40);
        if (random() % 2 == 0) n = std::to_string((random() >> (random() % 12)) | 1);
        std::string d = random() % 2 == 0 ? power_of_two(static_cast<unsigned>(random() % 1140)) : digits(1 + random() % 340);
        const RationalValue result = rational_to_double(n, d);
        mpq_set_str(exact, (n + "/" + d).c_str(), 10);
        mpq_canonicalize(exact);
        mpq_set_d(back, result.value);
        ASSERT_EQ(result.conversion == Conversion::exact, mpq_equal(exact, back) != 0) << n << " / " << d;
        for (const double other : {std::nextafter(result.value, -1.0), std::nextafter(result.value, 1e308)}) {
            const int order = compare_distance(exact, result.value, other);
            ASSERT_LE(order, 0) << n << " / " << d;
            if (order != 0) continue;
            std::uint64_t bits = 0;
            std::memcpy(&bits, &result.value, sizeof bits);
            ASSERT_EQ(bits & 1, 0U) << n << " / " << d;
        }
    }
    mpq_clears(exact, back, nullptr);
}

TEST(Rational, EveryDoubleReadsBack)
{
    std::mt19937_64 random{3};
    mpq_t exact;
    mpq_init(exact);
    for (int i = 0; i < 20'000; ++i) {
        double value = 0;
        const std::uint64_t bits = random();
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value)) continue;
        mpq_set_d(exact, value);
        std::vector<char> n(mpz_sizeinbase(mpq_numref(exact), 10) + 2);
        std::vector<char> d(mpz_sizeinbase(mpq_denref(exact), 10) + 2);
        const RationalValue result = rational_to_double(mpz_get_str(n.data(), 10, mpq_numref(exact)),
                                                        mpz_get_str(d.data(), 10, mpq_denref(exact)));
        ASSERT_EQ(result.value, value);
        ASSERT_EQ(result.conversion, Conversion::exact);
    }
    mpq_clear(exact);
}

}  // namespace
}  // namespace fastccd::tools
