#include "svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fastccd::tools::report {
namespace {

/// h0 to h8: little to much. In light, from light to dark blue; in dark the other way round, so that little is always near
/// the background.
constexpr const char* style = R"(<style>
.p{--surface:#fff;--ink:#1b1f24;--soft:#57606a;--grid:#dfe3e8;--blue:#0072b2;--orange:#b87400;--green:#007f5c;--vermilion:#c44900;
--purple:#a4558a;--sky:#2b87bd;--grey:#5f6870;--h0:#eaf1f8;--h1:#d3e3f1;--h2:#b5d2e9;--h3:#8fbcdc;--h4:#66a3cd;--h5:#4289bd;
--h6:#266fa8;--h7:#11548a;--h8:#083a66}
@media (prefers-color-scheme:dark){.p{--surface:#14181d;--ink:#e6e9ec;--soft:#a5adb6;--grid:#333a42;--blue:#4db1ea;--orange:#f0b03c;
--green:#2fc49a;--vermilion:#ff7d45;--purple:#dc93c1;--sky:#8ccdf2;--grey:#9aa3ab;--h0:#1c2731;--h1:#1d3447;--h2:#1e4562;--h3:#22587f;
--h4:#2f6f9d;--h5:#4789b8;--h6:#69a5cf;--h7:#95c3e3;--h8:#cbe3f4}}
.p .s{fill:var(--surface)}.p text{font:12px system-ui,-apple-system,"Segoe UI",sans-serif;fill:var(--ink)}
.p .title{font-size:14px;font-weight:600}.p .soft{fill:var(--soft)}.p .bold{font-weight:600}
.p .grid{stroke:var(--grid);stroke-width:1}.p .axis{stroke:var(--soft);stroke-width:1}
.p .blue{color:var(--blue)}.p .orange{color:var(--orange)}.p .green{color:var(--green)}.p .vermilion{color:var(--vermilion)}
.p .purple{color:var(--purple)}.p .sky{color:var(--sky)}.p .grey{color:var(--grey)}
.p .curve{fill:none;stroke:currentColor;stroke-width:1.6}.p .dashed{stroke-dasharray:5 4}.p .whisker{stroke:currentColor;stroke-width:1.2;opacity:.6}
.p .mark{fill:currentColor;stroke:var(--surface);stroke-width:1}.p .cross{fill:none;stroke:currentColor;stroke-width:2.2}
.p .none{fill:none;stroke:var(--grid)}.p .wrong{fill:var(--vermilion)}
.p .h0{fill:var(--h0)}.p .h1{fill:var(--h1)}.p .h2{fill:var(--h2)}.p .h3{fill:var(--h3)}.p .h4{fill:var(--h4)}.p .h5{fill:var(--h5)}
.p .h6{fill:var(--h6)}.p .h7{fill:var(--h7)}.p .h8{fill:var(--h8)}
</style>
)";

const char* css_name(Series series)
{
    constexpr std::array names{"blue", "orange", "green", "vermilion", "purple", "sky", "grey"};
    return names[static_cast<std::size_t>(series)];
}

/// About (0, 0).
const char* shape(Series series)
{
    switch (series) {
        case Series::blue: return "M0-6L6 0L0 6L-6 0Z";                                // diamond
        case Series::orange: return "M0-5.5L5.5 4.5H-5.5Z";                            // triangle
        case Series::green: return "M-4.5-4.5H4.5V4.5H-4.5Z";                          // square
        case Series::vermilion: return "M-4.5-4.5L4.5 4.5M-4.5 4.5L4.5-4.5";           // cross
        case Series::purple: return "M0-5.5V5.5M-5.5 0H5.5";                           // plus
        case Series::sky: return "M0 5.5L5.5-4.5H-5.5Z";                               // triangle on its tip
        case Series::grey: return "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0-4.5 0Z";  // circle
    }
    return "";
}

std::string title_element(std::string_view tooltip)
{
    return tooltip.empty() ? std::string{} : fmt::format("<title>{}</title>", escaped(tooltip));
}

}  // namespace

std::string escaped(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    }
    return out;
}

Svg::Svg(std::string_view title, std::string_view description, double height) : height_{height}
{
    body_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"p\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
        "role=\"img\" aria-label=\"{2}\">\n<desc>{3}</desc>\n{4}",
        width, height, escaped(title), escaped(description), style);
    rectangle({0, 0}, width, height, "s");
    text({14, 20}, title, Anchor::start, "title");
}

void Svg::line(Point from, Point to, std::string_view css_class)
{
    body_ += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", css_class, from.x, from.y, to.x, to.y);
}

void Svg::path(const std::vector<Point>& points, Series series, bool dashed)
{
    std::string data;
    for (const Point& point : points) data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", point.x, point.y);
    body_ += fmt::format("<path class=\"curve {}{}\" d=\"{}\"/>\n", css_name(series), dashed ? " dashed" : "", data);
}

void Svg::rectangle(Point corner, double w, double h, std::string_view css_class, std::string_view tooltip)
{
    body_ += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">{}</rect>\n",
                         css_class, corner.x, corner.y, w, h, title_element(tooltip));
}

void Svg::text(Point at, std::string_view content, Anchor anchor, std::string_view css_class)
{
    rotated_text(at, content, 0, anchor, css_class);
}

void Svg::rotated_text(Point at, std::string_view content, double degrees, Anchor anchor, std::string_view css_class)
{
    constexpr std::array anchors{"start", "middle", "end"};
    const std::string turn = degrees == 0 ? "" : fmt::format(" transform=\"rotate({:g} {:.1f} {:.1f})\"", degrees, at.x, at.y);
    body_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", css_class, at.x, at.y,
                         anchors[static_cast<std::size_t>(anchor)], turn, escaped(content));
}

void Svg::marker(Point at, Series series, std::string_view tooltip)
{
    const bool open = series == Series::vermilion || series == Series::purple;
    body_ += fmt::format("<g class=\"{}\" transform=\"translate({:.1f} {:.1f})\"><path class=\"{}\" d=\"{}\"/>{}</g>\n",
                         css_name(series), at.x, at.y, open ? "cross" : "mark", shape(series), title_element(tooltip));
}

void Svg::whisker(Point from, Point to, Series series)
{
    body_ += fmt::format("<g class=\"{}\"><path class=\"whisker\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/></g>\n", css_name(series),
                         from.x, from.y, to.x, to.y);
}

double Axis::share(double value) const
{
    const double s =
        logarithmic ? std::log(std::max(value, 1e-300) / low) / std::log(high / low) : (value - low) / (high - low);
    return std::clamp(s, 0.0, 1.0);
}

std::string power_of_ten(int exponent)
{
    if (exponent == 0) return "1";
    if (exponent == 1) return "10";
    if (exponent == 2) return "100";
    if (exponent == -1) return "0.1";
    constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char c : std::to_string(std::abs(exponent))) text += digits[static_cast<std::size_t>(c - '0')];
    return text;
}

namespace {

/// 1, 2 or 5 times a power of ten.
double one_two_five(int step)
{
    constexpr std::array mantissas{1.0, 2.0, 5.0};
    const int power = step >= 0 ? step / 3 : -((2 - step) / 3);
    return mantissas[static_cast<std::size_t>(step - 3 * power)] * std::pow(10.0, power);
}

}  // namespace

Axis log_axis(std::string label, double least, double most)
{
    const int first = static_cast<int>(std::floor(std::log10(least) + 1e-9));
    const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(most) - 1e-9)));
    Axis axis{std::pow(10.0, first), std::pow(10.0, last), true, std::move(label), {}};
    if (last - first <= 3) {
        int low = 3 * first, high = 3 * last;
        while (one_two_five(low + 1) <= least && low + 1 < high) ++low;
        while (one_two_five(high - 1) >= most && low < high - 1) --high;
        axis.low = one_two_five(low);
        axis.high = one_two_five(high);
        for (int step = low; step <= high; ++step)
            axis.ticks.emplace_back(one_two_five(step), fmt::format("{:g}", one_two_five(step)));
        return axis;
    }
    const int step = (last - first) / 9 + 1;
    for (int exponent = first; exponent <= last; exponent += step)
        axis.ticks.emplace_back(std::pow(10.0, exponent), power_of_ten(exponent));
    return axis;
}

Axis linear_axis(std::string label, double most)
{
    const double raw = most / 5, unit = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = raw <= unit ? unit : raw <= 2 * unit ? 2 * unit : raw <= 5 * unit ? 5 * unit : 10 * unit;
    Axis axis{0, std::ceil(most / step) * step, false, std::move(label), {}};
    for (double tick = 0; tick < axis.high + 0.5 * step; tick += step) axis.ticks.emplace_back(tick, fmt::format("{:g}", tick));
    return axis;
}

Chart::Chart(std::string_view title, std::string_view description, Axis x, Axis y, double height, std::size_t legend_lines)
    : svg_{title, description, height},
      x_{std::move(x)},
      y_{std::move(y)},
      bottom_{46 + 18 * static_cast<double>(legend_lines)},
      legend_{svg_, 14, height - 18 * static_cast<double>(legend_lines) + 8}
{
    const double floor = height - bottom_, wall = Svg::width - right_;
    for (const auto& [value, name] : x_.ticks) {
        const double place = at(value, y_.low).x;
        svg_.line({place, top_}, {place, floor}, "grid");
        svg_.text({place, floor + 15}, name, Anchor::middle, "soft");
    }
    for (const auto& [value, name] : y_.ticks) {
        const double place = at(x_.low, value).y;
        svg_.line({left_, place}, {wall, place}, "grid");
        svg_.text({left_ - 6, place + 4}, name, Anchor::end, "soft");
    }
    svg_.line({left_, floor}, {wall, floor}, "axis");
    svg_.line({left_, top_}, {left_, floor}, "axis");
    svg_.text({(left_ + wall) / 2, floor + 32}, x_.label, Anchor::middle);
    svg_.rotated_text({14, (top_ + floor) / 2}, y_.label, -90, Anchor::middle);
}

Point Chart::at(double x, double y) const
{
    const double floor = svg_.height() - bottom_;
    return {left_ + x_.share(x) * (Svg::width - right_ - left_), floor - y_.share(y) * (floor - top_)};
}

void Chart::points(const std::vector<Point>& values, Series series, const std::vector<std::string>& tooltips)
{
    for (std::size_t i = 0; i < values.size(); ++i) {
        svg_.marker(at(values[i].x, values[i].y), series, i < tooltips.size() ? tooltips[i] : std::string{});
    }
}

void Chart::curve(const std::vector<Point>& values, Series series, bool dashed)
{
    std::vector<Point> places;
    for (const Point& value : values) places.push_back(at(value.x, value.y));
    svg_.path(places, series, dashed);
}

void Chart::level(double y, std::string_view name, Series series)
{
    const Point left = at(x_.low, y), right = at(x_.high, y);
    svg_.path({left, right}, series, true);
    svg_.text({right.x - 4, right.y - 5}, name, Anchor::end, "soft");
}

Point Legend::advance(std::string_view text, double margin)
{
    // Letters as bytes less those that continue one in UTF-8.
    const auto letters = std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
    const double width = margin + 10 + 6.4 * static_cast<double>(letters);
    if (x_ + width > Svg::width && x_ > left_) {
        x_ = left_;
        y_ += 18;
    }
    const Point at{x_, y_};
    x_ += width;
    return at;
}

void Legend::add(Series series, std::string_view name)
{
    const Point at = advance(name, 16);
    svg_.marker({at.x + 6, at.y - 4}, series);
    svg_.text({at.x + 16, at.y}, name);
}

void Legend::note(std::string_view text) { svg_.text(advance(text, 0), text, Anchor::start, "soft"); }

}  // namespace fastccd::tools::report
