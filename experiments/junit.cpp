#include "experiments/junit.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

// Length of the UTF-8 sequence at the start of `text` whose character XML 1.0 allows; none where there is none.
std::optional<std::size_t> valid_sequence(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) {
        const bool allowed = first >= 0x20 || first == '\t' || first == '\n' || first == '\r';
        return allowed ? std::optional<std::size_t>(1) : std::nullopt;
    }
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return std::nullopt;
    unsigned code = first & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return std::nullopt;
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (overlong || surrogate || code > 0x10FFFF || code == 0xFFFE || code == 0xFFFF) return std::nullopt;
    return length;
}

std::string print_properties(const std::vector<std::pair<std::string, std::string>>& properties,
                             std::string_view indent) {
    if (properties.empty()) return "";
    std::string text = fmt::format("{}<properties>\n", indent);
    for (const auto& [name, value] : properties) {
        text.append(
            fmt::format("{}  <property name=\"{}\" value=\"{}\"/>\n", indent, escape_xml(name), escape_xml(value)));
    }
    return text.append(fmt::format("{}</properties>\n", indent));
}

std::string print_case(const JunitCase& test) {
    std::string text = fmt::format("    <testcase name=\"{}\" classname=\"{}\" time=\"0\">\n", escape_xml(test.name),
                                   escape_xml(test.class_name));
    text.append(print_properties(test.properties, "      "));
    if (test.outcome == JunitCase::Outcome::passed) {
        text.append(fmt::format("      <system-out>{}</system-out>\n", escape_xml(test.text)));
    } else {
        const char* element = test.outcome == JunitCase::Outcome::failed ? "failure" : "error";
        text.append(fmt::format("      <{0} message=\"{1}\">{2}</{0}>\n", element, escape_xml(test.message),
                                escape_xml(test.text)));
    }
    return text.append("    </testcase>\n");
}

}  // namespace

std::string escape_xml(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto length = valid_sequence(text);
        const char letter = text[0];
        if (!length) {
            result.append(replacement);
        } else if (letter == '&') {
            result.append("&amp;");
        } else if (letter == '<') {
            result.append("&lt;");
        } else if (letter == '>') {
            result.append("&gt;");
        } else if (letter == '"') {
            result.append("&quot;");
        } else if (letter == '\t' || letter == '\n' || letter == '\r') {
            result.append(fmt::format("&#{};", static_cast<int>(letter)));
        } else {
            result.append(text.substr(0, *length));
        }
        text.remove_prefix(length.value_or(1));
    }
    return result;
}

std::string print_junit(const JunitSuite& suite) {
    const auto count = [&](JunitCase::Outcome outcome) {
        return std::ranges::count(suite.cases, outcome, &JunitCase::outcome);
    };
    const std::string counts = fmt::format(
        "name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", escape_xml(suite.name),
        suite.cases.size(), count(JunitCase::Outcome::failed), count(JunitCase::Outcome::error), suite.seconds);
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite {0} skipped=\"0\" "
        "timestamp=\"{1}\">\n",
        counts, escape_xml(suite.timestamp));
    text.append(print_properties(suite.properties, "    "));
    for (const JunitCase& test : suite.cases) text.append(print_case(test));
    return text.append("  </testsuite>\n</testsuites>\n");
}

}  // namespace plumb
