// The page of `fastccd report` in a real browser: headless Chromium, Debian's package chromium.
#include "report_test.hpp"

#include <cstdio>
#include <iostream>

#include <gtest/gtest.h>

namespace fastccd::testing {
namespace {

using Json = nlohmann::json;

/// Shows the page in a frame 400 pixels wide and measures it. Sizes are those on the screen.
constexpr const char* measuring_page = R"(<!doctype html><meta charset="utf-8"><body style="margin:0">
<iframe src="report.html" style="border:0;width:400px;height:800px"></iframe><pre id="result"></pre><script>
const frame = document.querySelector("iframe");
function luminance(color) {
  const [r, g, b] = color.match(/[\d.]+/g).map(Number).map(x => (x /= 255) <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
function contrast(a, b) {
  const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
}
frame.onload = () => {
  const page = frame.contentDocument, style = element => frame.contentWindow.getComputedStyle(element);
  const result = {width: page.documentElement.clientWidth, scrollWidth: page.documentElement.scrollWidth, pictures: [],
                  background: style(page.body).backgroundColor, contrast: contrast(style(page.body).color, style(page.body).backgroundColor)};
  for (const figure of page.querySelectorAll("figure")) {
    const svg = figure.querySelector("svg"), box = svg.getBoundingClientRect(), surface = style(svg.querySelector(".s")).fill;
    const texts = [...svg.querySelectorAll("text")], scale = svg.getScreenCTM().a;
    result.pictures.push({name: figure.id, width: box.width, height: box.height, right: box.right,
      marks: svg.querySelectorAll("path,rect").length,
      leastText: Math.min(...texts.map(text => parseFloat(style(text).fontSize) * scale)),
      leastContrast: Math.min(...texts.map(text => contrast(style(text).fill, surface))),
      outside: texts.filter(text => { const b = text.getBoundingClientRect(); return b.left < box.left - 1 || b.right > box.right + 1 || b.bottom > box.bottom + 1; })
                    .map(text => text.textContent)});
  }
  document.getElementById("result").textContent = "MEASURED" + JSON.stringify(result) + "END";
};
</script>)";

struct Browser {
    std::string dom;
    std::string log;
};

Browser browse(const std::string& url, const std::string& option)
{
    const ScratchDirectory scratch;
    const std::string command =
        "timeout 120 chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
        "--hide-scrollbars --allow-file-access-from-files --window-size=800,900 "
        "--enable-logging=stderr --virtual-time-budget=5000 --user-data-dir='" +
        (scratch / "profile") + "' " + option + " --dump-dom 'file://" + url + "' >'" + (scratch / "dom") + "' 2>'" +
        (scratch / "log") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return {read_text(scratch / "dom"), read_text(scratch / "log")};
}

bool have_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

void check(const std::string& option, bool dark)
{
    const Browser browser = browse(report().file("measure.html"), option);
    EXPECT_EQ(browser.log.find("CONSOLE"), std::string::npos) << browser.log;
    const std::size_t begin = browser.dom.rfind("MEASURED{"), end = browser.dom.rfind("}END");
    ASSERT_NE(begin, std::string::npos) << browser.dom.substr(0, 2000) << browser.log;
    const Json result = Json::parse(browser.dom.substr(begin + 8, end + 1 - begin - 8));

    EXPECT_EQ(result["width"], 400);
    EXPECT_LE(result["scrollWidth"], 400) << "the page must be scrolled sideways";
    EXPECT_GE(result["contrast"], 7.0);
    EXPECT_EQ(result["background"] == "rgb(255, 255, 255)", !dark) << result["background"];

    std::vector<std::string> files, names;
    for (const std::string& name : files_in(report().folder())) {
        if (name.ends_with(".svg")) files.push_back(name.substr(0, name.size() - 4));
    }
    for (const Json& picture : result["pictures"]) {
        const std::string name = picture["name"];
        names.push_back(name);
        EXPECT_GT(picture["width"], 300) << name;
        EXPECT_GT(picture["height"], 150) << name;
        EXPECT_LE(picture["right"], 400) << name;
        EXPECT_GT(picture["marks"], 10) << name;
        EXPECT_GE(picture["leastText"], 8.5) << name << ": pixels";
        EXPECT_GE(picture["leastContrast"], 4.5) << name;
        EXPECT_EQ(picture["outside"], Json::array()) << name << ": text beyond the picture";
    }
    std::ranges::sort(names);
    EXPECT_EQ(names, files) << "every picture is a file, and in the page";
    EXPECT_GE(names.size(), 8u);
}

TEST(ReportPage, IsReadableInABrowser)
{
    if (!have_browser()) GTEST_SKIP() << "NO BROWSER: install Debian's package chromium; the page was not looked at here";
    // Beside the page, because a browser lets a page look into frames of its own folder only.
    std::ofstream{report().file("measure.html")} << measuring_page;
    check("", false);
    check("--blink-settings=preferredColorScheme=0", true);
    std::filesystem::remove(report().file("measure.html"));
}

}  // namespace
}  // namespace fastccd::testing
