#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include "experiments/figures.h"
#include "experiments/no_value.h"
#include "experiments/svg_parts.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

// Pixels.
constexpr double picture_width = 240.0, sheet_gap = 6.0, sheet_head = 58.0, row_title = 16.0, sheet_foot = 10.0;

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

// As cells name the truth.
std::string truth_of(const PictureSet& set) { return set.truth.starts_with("within") ? "limited" : set.truth; }

bool is_wanted(const Figure& figure, const PictureSet& set) {
    Selector where = figure.where;
    where.wanted.erase("method");
    return where.matches({set.scene, set.view, set.plane, truth_of(set), "", ""});
}

// Columns of the sheet.
std::vector<std::string> labels_of(const Figure& figure, const std::vector<PictureSet>& pictures) {
    if (!figure.show.empty()) return figure.show;
    std::vector<std::string> labels;
    for (const PictureSet& set : pictures) {
        if (!is_wanted(figure, set)) continue;
        for (const Picture& picture : set.images) {
            if (std::ranges::find(labels, picture.label) == labels.end()) labels.push_back(picture.label);
        }
    }
    return labels;
}

const Picture* find_picture(const PictureSet& set, const std::string& label, bool is_error) {
    const auto found = std::ranges::find_if(set.images, [&](const Picture& picture) {
        return picture.label == label && (picture.kind == "error") == is_error;
    });
    return found == set.images.end() ? nullptr : &*found;
}

// One figure of pictures while it is put together: a row of them for each view, plane and truth, a column per label.
class PictureSheet {
public:
    PictureSheet(const Figure& figure, const std::vector<PictureSet>& pictures, const std::filesystem::path& folder)
        : figure_(figure), pictures_(pictures), folder_(folder), labels_(labels_of(figure, pictures)) {}

    std::string print() {
        for (const PictureSet& set : pictures_) {
            if (!is_wanted(figure_, set)) continue;
            add_row(set, false);
            if (figure_.errors) add_row(set, true);
        }
        if (body_.empty()) return "";
        const double title_width = 2.0 * sheet_gap + svg_title_letter_width * static_cast<double>(figure_.title.size());
        std::string svg = open_svg(std::max(column(labels_.size()), title_width), y_ + sheet_foot, figure_.title);
        for (std::size_t i = 0; i < labels_.size(); ++i)
            svg += svg_text(column(i), sheet_head - 10.0, "start", labels_[i], "font-size=\"12\" font-weight=\"bold\"");
        return svg + body_ + "</svg>\n";
    }

private:
    static double column(std::size_t index) {
        return sheet_gap + static_cast<double>(index) * (picture_width + sheet_gap);
    }

    void add_row(const PictureSet& set, bool is_error) {
        double height = 0.0;
        std::string row;
        for (std::size_t i = 0; i < labels_.size(); ++i) {
            const Picture* picture = find_picture(set, labels_[i], is_error);
            if (!picture) continue;
            const std::string png = read_png(folder_ / picture->file);
            height = picture_width / aspect_of(png);
            row += fmt::format(
                "<image x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" "
                "href=\"data:image/png;base64,{}\"/>\n",
                column(i), y_ + row_title, picture_width, height, OIIO::Strutil::base64_encode(png));
        }
        if (row.empty()) return;
        const std::string title = is_error ? fmt::format("error, the last colour is {:.2g}", set.error_scale)
                                           : fmt::format("{} / {}: {}{}", set.scene, set.view, set.plane,
                                                         set.truth.empty() ? "" : fmt::format(", truth {}", set.truth));
        body_ += svg_text(sheet_gap, y_ + row_title - 4.0, "start", title) + row;
        y_ += row_title + height + sheet_gap;
    }

    const Figure& figure_;
    const std::vector<PictureSet>& pictures_;
    const std::filesystem::path& folder_;
    const std::vector<std::string> labels_;
    std::string body_;
    double y_ = sheet_head;
};

}  // namespace

std::string print_picture_sheet(const Figure& figure, const std::vector<PictureSet>& pictures,
                                const std::filesystem::path& folder) {
    return PictureSheet(figure, pictures, folder).print();
}

ResultTable picture_numbers(const Figure& figure, const std::vector<PictureSet>& pictures,
                            const std::vector<Cell>& cells) {
    const std::vector<std::string> measures = {"rmse", "bias", "ssim", "ms"};
    ResultTable table;
    table.columns = {"scene", "place", "plane", "truth", "method"};
    table.names = table.columns.size();
    table.columns.insert(table.columns.end(), measures.begin(), measures.end());
    table.columns.emplace_back("last colour of the error map");
    for (const PictureSet& set : pictures) {
        if (!is_wanted(figure, set)) continue;
        for (const std::string& label : labels_of(figure, pictures)) {
            if (label == "truth" || !find_picture(set, label, false)) continue;
            const auto cell = std::ranges::find_if(cells, [&](const Cell& candidate) {
                return candidate.scene == set.scene && candidate.place == set.view && candidate.plane == set.plane &&
                       candidate.truth == truth_of(set) && candidate.method == label;
            });
            std::vector<std::string> row = {set.scene, set.view, set.plane, truth_of(set), label};
            for (const std::string& measure : measures) {
                const double value = cell == cells.end() ? no_value : measure_of(*cell, measure);
                row.push_back(std::isnan(value) ? "" : fmt::format("{:.6g}", value));
            }
            row.push_back(find_picture(set, label, true) ? fmt::format("{:.6g}", set.error_scale) : "");
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

}  // namespace plumb
