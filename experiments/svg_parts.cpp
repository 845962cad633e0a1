#include "experiments/svg_parts.h"

#include <fmt/format.h>

#include "experiments/page.h"

namespace plumb {

std::string open_svg(double width, double height, const std::string& title) {
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
               "{1:.0f}\" font-family=\"DejaVu Sans, Helvetica, sans-serif\" font-size=\"11\" fill=\"{2}\" "
               "role=\"img\">\n<title>{3}</title>\n<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
               width, height, svg_ink, escape_html(title)) +
           svg_text(0.5 * width, 25.0, "middle", title, "font-size=\"16\" font-weight=\"bold\"");
}

std::string svg_text(double x, double y, const std::string& anchor, const std::string& content,
                     const std::string& attributes) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor,
                       attributes.empty() ? "" : " " + attributes, escape_html(content));
}

std::string svg_line(double x1, double y1, double x2, double y2, const std::string& colour,
                     const std::string& attributes) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"{}/>\n", x1, y1, x2,
                       y2, colour, attributes.empty() ? "" : " " + attributes);
}

}  // namespace plumb
