// Pictures as plain SVG: text, lines and a few shapes, with their own colours for light and for dark.
//
// Own code because it is small, because the pictures are then part of the page (sharp, searchable, a few kilobytes) and
// follow its colours, and because nothing has to be installed to draw them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fastccd::tools::report {

/// For element content and attribute values.
[[nodiscard]] std::string escaped(std::string_view text);

/// Colours that people with any kind of colour blindness tell apart (Okabe and Ito 2008), each with a shape of its own.
enum class Series { blue, orange, green, vermilion, purple, sky, grey };

struct Point {
    double x, y;
};

enum class Anchor { start, middle, end };

/// A picture of `width` units, which are shown as CSS pixels where there is room and shrink where there is not: at 400 pixels
/// text must still be readable, hence no pictures wider than 480 with text of 12.
class Svg {
public:
    static constexpr double width = 480;

    /// `title` is shown on top and read out; `description` is read out.
    Svg(std::string_view title, std::string_view description, double height);

    void line(Point from, Point to, std::string_view css_class);
    void path(const std::vector<Point>& points, Series series, bool dashed);
    void rectangle(Point corner, double w, double h, std::string_view css_class, std::string_view tooltip = {});
    void text(Point at, std::string_view content, Anchor anchor = Anchor::start, std::string_view css_class = "t");
    /// Upwards.
    void rotated_text(Point at, std::string_view content, double degrees, Anchor anchor, std::string_view css_class = "t");
    void marker(Point at, Series series, std::string_view tooltip = {});
    void whisker(Point from, Point to, Series series);

    [[nodiscard]] double height() const { return height_; }
    [[nodiscard]] std::string str() const { return body_ + "</svg>\n"; }

private:
    double height_;
    std::string body_;
};

/// Names of series, side by side and in as many lines as they need.
class Legend {
public:
    /// From (x, y), the first line's base.
    Legend(Svg& svg, double x, double y) : svg_{svg}, left_{x}, x_{x}, y_{y} {}
    void add(Series series, std::string_view name);
    /// Words alone.
    void note(std::string_view text);

private:
    /// Room for so many letters after the cursor or in the next line; the place of the first.
    Point advance(std::string_view text, double margin);

    Svg& svg_;
    double left_, x_, y_;
};

/// A range of values along one side of a chart.
struct Axis {
    double low, high;
    bool logarithmic;
    std::string label;
    std::vector<std::pair<double, std::string>> ticks;

    /// 0 at `low`, 1 at `high`; beyond them clamped.
    [[nodiscard]] double share(double value) const;
};

/// From below the least value to above the largest, with a tick at every power of ten or, if these are many, every second, third
/// and so on; over little more than two powers also at 2 and 5 times a power.
[[nodiscard]] Axis log_axis(std::string label, double least, double most);
/// From 0.
[[nodiscard]] Axis linear_axis(std::string label, double most);

/// 1e-9 as 10⁻⁹.
[[nodiscard]] std::string power_of_ten(int exponent);

/// Two axes and what is drawn between them.
class Chart {
public:
    Chart(const Chart&) = delete;
    Chart& operator=(const Chart&) = delete;
    Chart(std::string_view title, std::string_view description, Axis x, Axis y, double height = 360,
          std::size_t legend_lines = 1);

    [[nodiscard]] Point at(double x, double y) const;
    [[nodiscard]] Svg& svg() { return svg_; }

    void points(const std::vector<Point>& values, Series series, const std::vector<std::string>& tooltips);
    void curve(const std::vector<Point>& values, Series series, bool dashed);
    /// A horizontal line with a name.
    void level(double y, std::string_view name, Series series);
    /// Appends to the legend below.
    void legend(Series series, std::string_view name) { legend_.add(series, name); }
    void legend_note(std::string_view text) { legend_.note(text); }

    [[nodiscard]] std::string str() const { return svg_.str(); }

private:
    Svg svg_;
    Axis x_, y_;
    double left_ = 56, right_ = 24, top_ = 34, bottom_;
    Legend legend_;
};

}  // namespace fastccd::tools::report
