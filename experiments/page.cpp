#include "experiments/page.h"

#include <fstream>
#include <map>
#include <sstream>

#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include "embedded/page.h"
#include "experiments/page_data.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

std::string base64_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    if (!stream || !(bytes << stream.rdbuf())) {
        throw ImageError(fmt::format("cannot read '{}', which belongs on the page", file.string()));
    }
    return OIIO::Strutil::base64_encode(bytes.str());
}

// An element that no browser runs; the script takes its text when it needs it.
void append_element(std::string& page, std::string_view name, std::size_t number, std::string_view text) {
    page += fmt::format("<script type=\"text/plain\" id=\"{}-{}\">", name, number);
    page.append(text).append("</script>\n");
}

std::string planes_of(const PageData& data, const std::filesystem::path& folder) {
    std::string text;
    for (std::size_t i = 0; i < data.planes.size(); ++i) {
        append_element(text, "values", i, base64_of(folder / data.planes[i]));
    }
    return text;
}

std::string frames_of(const PageData& data, const std::filesystem::path& folder) {
    std::string text;
    for (std::size_t i = 0; i < data.strips.size(); ++i) {
        std::string lines;
        for (const std::string& file : data.strips[i]) lines.append(base64_of(folder / file)).append("\n");
        append_element(text, "frames", i, lines);
    }
    return text;
}

// Replaces each {{name}} of the template by its value, or by the embedded file of that name; what is put in is not
// searched again.
std::string fill(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
    std::string result;
    while (true) {
        const auto open = text.find("{{");
        if (open == std::string_view::npos) break;
        const auto close = text.find("}}", open);
        const std::string_view name = text.substr(open + 2, close - open - 2);
        const auto value = values.find(name);
        result += text.substr(0, open);
        result += value == values.end() ? embedded::page::find(name) : std::string_view(value->second);
        text.remove_prefix(close + 2);
    }
    return result.append(text);
}

}  // namespace

std::string print_page(const RunResults& results, const std::filesystem::path& folder) {
    PageData data = page_data(results, folder);
    return fill(embedded::page::find("page.html"), {{"title", escape_html(results.experiment.title)},
                                                    {"question", escape_html(results.experiment.question)},
                                                    {"planes", planes_of(data, folder)},
                                                    {"frames", frames_of(data, folder)},
                                                    {"data", escape_for_script(std::move(data.json))}});
}

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        switch (letter) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += letter;
        }
    }
    return result;
}

std::string escape_for_script(std::string json) {
    // Within JSON '<' stands in strings only, where an escape means the same.
    for (auto place = json.find('<'); place != std::string::npos; place = json.find('<', place))
        json.replace(place, 1, "\\u003c");
    return json;
}

}  // namespace plumb
