#include <algorithm>
#include <fstream>
#include <sstream>

#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include "experiments/figures.h"
#include "experiments/page.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

// Pixels.
constexpr double picture_width = 240.0, gap = 6.0, head = 58.0, row_title = 16.0, foot = 10.0;

// PNG files tell their size in bytes 16 to 23, big-endian (PNG specification, section 11.2.2).
double aspect_of(const std::string& png) {
    const auto number_at = [&](std::size_t at) {
        double number = 0.0;
        for (std::size_t i = at; i < at + 4; ++i) number = 256.0 * number + static_cast<unsigned char>(png[i]);
        return number;
    };
    return number_at(16) / number_at(20);
}

std::string read_png(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    if (!stream || !(bytes << stream.rdbuf()) || bytes.str().size() < 24)
        throw ImageError(fmt::format("cannot read '{}', which belongs in a figure", file.string()));
    return bytes.str();
}

bool is_wanted(const Figure& figure, const PictureSet& set) {
    Selector where = figure.where;
    where.wanted.erase("method");
    const std::string truth = set.truth.starts_with("within") ? "limited" : set.truth;
    return where.matches({set.scene, set.view, set.plane, truth, "", ""});
}

const Picture* find_picture(const PictureSet& set, const std::string& label, bool is_error) {
    const auto found = std::ranges::find_if(set.images, [&](const Picture& picture) {
        return picture.label == label && (picture.kind == "error") == is_error;
    });
    return found == set.images.end() ? nullptr : &*found;
}

std::string text(double x, double y, const std::string& content, const std::string& attributes) {
    return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" {}>{}</text>\n", x, y, attributes, escape_html(content));
}

}  // namespace

std::string print_picture_sheet(const Figure& figure, const std::vector<PictureSet>& pictures,
                                const std::filesystem::path& folder) {
    std::vector<std::string> labels = figure.show;
    for (const PictureSet& set : pictures) {
        if (!figure.show.empty() || !is_wanted(figure, set)) continue;
        for (const Picture& picture : set.images) {
            if (std::ranges::find(labels, picture.label) == labels.end()) labels.push_back(picture.label);
        }
    }
    std::string body;
    double y = head;
    const auto add_row = [&](const PictureSet& set, bool is_error) {
        double height = 0.0;
        std::string row;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const Picture* picture = find_picture(set, labels[i], is_error);
            if (!picture) continue;
            const std::string png = read_png(folder / picture->file);
            height = picture_width / aspect_of(png);
            row += fmt::format(
                "<image x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" "
                "href=\"data:image/png;base64,{}\"/>\n",
                gap + static_cast<double>(i) * (picture_width + gap), y + row_title, picture_width, height,
                OIIO::Strutil::base64_encode(png));
        }
        if (row.empty()) return;
        const std::string title = is_error ? fmt::format("error, the last colour is {:.2g}", set.error_scale)
                                           : fmt::format("{} / {}: {}{}", set.scene, set.view, set.plane,
                                                         set.truth.empty() ? "" : fmt::format(", truth {}", set.truth));
        body += text(gap, y + row_title - 4.0, title, "font-size=\"11\"") + row;
        y += row_title + height + gap;
    };
    for (const PictureSet& set : pictures) {
        if (!is_wanted(figure, set)) continue;
        add_row(set, false);
        if (figure.errors) add_row(set, true);
    }
    if (body.empty()) return "";
    const double width = std::max(gap + static_cast<double>(labels.size()) * (picture_width + gap),
                                  20.0 + 10.0 * static_cast<double>(figure.title.size()));
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" "
        "font-family=\"DejaVu Sans, Helvetica, sans-serif\" fill=\"#222222\" role=\"img\">\n<title>{2}</title>\n"
        "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
        width, y + foot, escape_html(figure.title));
    svg += text(gap, 22.0, figure.title, "font-size=\"16\" font-weight=\"bold\"");
    for (std::size_t i = 0; i < labels.size(); ++i) {
        svg += text(gap + static_cast<double>(i) * (picture_width + gap), head - 10.0, labels[i],
                    "font-size=\"12\" font-weight=\"bold\"");
    }
    return svg + body + "</svg>\n";
}

}  // namespace plumb
