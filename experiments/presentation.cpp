#include "experiments/presentation.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace plumb {
namespace {

std::string selector_text(const ConfigValue& value) {
    if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
    if (const auto* whole = std::get_if<std::int64_t>(&value.value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value.value)) return fmt::format("{:g}", *number);
    return "";
}

Selector read_selector(const ConfigReader& reader, std::string_view key, const ConfigValue& value) {
    const auto* members = std::get_if<ConfigMembers>(&value.value);
    if (!members) reader.fail(key, R"(must be a table, such as { method = "two_layers" })");
    Selector selector;
    for (const ConfigMember& member : *members) {
        if (std::ranges::find(cell_attributes(), member.key) == cell_attributes().end())
            reader.fail(key,
                        fmt::format("no attribute '{}'; {}", member.key, name_hint(member.key, cell_attributes())));
        std::vector<std::string> texts;
        if (const auto* array = std::get_if<ConfigArray>(&member.value.value)) {
            for (const ConfigValue& entry : *array) texts.push_back(selector_text(entry));
        } else {
            texts.push_back(selector_text(member.value));
        }
        if (texts.empty() || std::ranges::find(texts, "") != texts.end())
            reader.fail(key, fmt::format("'{}' must be a text or a number, or an array of some", member.key));
        selector.wanted[member.key] = std::move(texts);
    }
    return selector;
}

Selector optional_selector(ConfigReader& reader, std::string_view key) {
    const ConfigValue* value = reader.value(key);
    return value ? read_selector(reader, key, *value) : Selector{};
}

MeasuredQuantity read_quantity(ConfigReader& reader) {
    MeasuredQuantity quantity;
    quantity.measure = reader.required_text("measure");
    quantity.where = optional_selector(reader, "where");
    constexpr std::array kinds = {std::pair{"value", QuantityKind::value}, std::pair{"ratio", QuantityKind::ratio},
                                  std::pair{"difference", QuantityKind::difference},
                                  std::pair{"slope", QuantityKind::slope}};
    int found = 0;
    for (const auto& [key, kind] : kinds) {
        const ConfigValue* value = reader.value(key);
        if (!value) continue;
        ++found;
        quantity.kind = kind;
        if (kind == QuantityKind::value || kind == QuantityKind::slope) {
            quantity.first = read_selector(reader, key, *value);
            continue;
        }
        const auto* pair = std::get_if<ConfigArray>(&value->value);
        if (!pair || pair->size() != 2)
            reader.fail(key, R"(must be an array of two tables, such as [{ method = "a" }, { method = "b" }])");
        quantity.first = read_selector(reader, key, pair->front());
        quantity.second = read_selector(reader, key, pair->back());
    }
    if (found != 1) reader.fail("", "must have one of 'value', 'ratio', 'difference' and 'slope'");
    return quantity;
}

Claim read_claim(ConfigReader& reader) {
    Claim claim;
    claim.claim = reader.required_text("claim");
    claim.source = reader.required_text("source");
    claim.test = reader.required_text("test");
    claim.quantity = read_quantity(reader);
    claim.unit = reader.text("unit", "");
    if (reader.has("above")) claim.above = reader.number("above", 0.0, -no_limit, no_limit);
    if (reader.has("below")) claim.below = reader.number("below", 0.0, -no_limit, no_limit);
    if (!claim.above && !claim.below) reader.fail("", "must say where it holds: 'above', 'below', or both");
    if (claim.above && claim.below && *claim.above >= *claim.below)
        reader.fail("above", fmt::format("is {}, which leaves nothing below {}", *claim.above, *claim.below));
    reader.finish();
    return claim;
}

Originals read_originals(ConfigReader& reader) {
    Originals originals;
    originals.title = reader.required_text("title");
    originals.source = reader.required_text("source");
    originals.measure = reader.required_text("measure");
    originals.unit = reader.text("unit", "ms");
    originals.where = optional_selector(reader, "where");
    for (ConfigReader& row : reader.tables("rows")) {
        OriginalRow entry;
        entry.name = row.required_text("name");
        if (!row.has("original")) row.fail("original", "is missing: the number that the source prints");
        entry.original = row.number("original", 0.0, 0.0, no_limit);
        entry.of = optional_selector(row, "of");
        entry.over = row.text("over", "");
        row.finish();
        originals.rows.push_back(std::move(entry));
    }
    if (originals.rows.empty()) reader.fail("", "'rows' is missing: write at least one");
    std::vector<std::string> names;
    for (const OriginalRow& row : originals.rows) names.push_back(row.name);
    for (const OriginalRow& row : originals.rows) {
        if (!row.over.empty() && std::ranges::find(names, row.over) == names.end())
            reader.fail("rows",
                        fmt::format("'{}' is over no row '{}'; {}", row.name, row.over, name_hint(row.over, names)));
    }
    reader.finish();
    return originals;
}

std::string read_attribute(ConfigReader& reader, std::string_view key, std::string fallback) {
    std::string name = reader.text(key, std::move(fallback));
    if (!name.empty() && std::ranges::find(cell_attributes(), name) == cell_attributes().end())
        reader.fail(key, fmt::format("no attribute '{}'; {}", name, name_hint(name, cell_attributes())));
    return name;
}

bool read_is_linear(ConfigReader& reader, std::string_view key) {
    const std::string scale = reader.text(key, "logarithmic");
    if (scale != "logarithmic" && scale != "linear")
        reader.fail(key, fmt::format("no scale '{}'; {}", scale, name_hint(scale, {"logarithmic", "linear"})));
    return scale == "linear";
}

Figure read_figure(ConfigReader& reader) {
    Figure figure;
    figure.title = reader.required_text("title");
    figure.source = reader.text("source", "");
    const std::string kind = reader.text("kind", "curves");
    const std::vector<std::string> kinds = {"curves", "bars", "table", "pictures"};
    const auto place = std::ranges::find(kinds, kind);
    if (place == kinds.end()) reader.fail("kind", fmt::format("no kind '{}'; {}", kind, name_hint(kind, kinds)));
    figure.kind = static_cast<FigureKind>(place - kinds.begin());
    figure.where = optional_selector(reader, "where");
    if (figure.kind == FigureKind::curves || figure.kind == FigureKind::bars) {
        const bool is_bars = figure.kind == FigureKind::bars;
        figure.x = is_bars ? read_attribute(reader, "x", "scene") : reader.text("x", figure.x);
        figure.y = reader.text("y", figure.y);
        figure.series = read_attribute(reader, "series", is_bars ? "method" : "curve");
        figure.panels = read_attribute(reader, "panels", "");
        figure.relative_to = optional_selector(reader, "relative_to");
        figure.x_label = reader.text("x_label", is_bars ? "" : figure.x);
        figure.y_label = reader.text("y_label", figure.y);
        if (!is_bars) figure.linear_x = read_is_linear(reader, "x_scale");
        figure.linear_y = is_bars || read_is_linear(reader, "y_scale");
    } else if (figure.kind == FigureKind::table) {
        figure.rows = reader.texts("rows", {"scene", "method"});
        figure.columns = reader.texts("columns", {"rmse", "ms"});
        for (const std::string& row : figure.rows) {
            if (std::ranges::find(cell_attributes(), row) == cell_attributes().end())
                reader.fail("rows", fmt::format("no attribute '{}'; {}", row, name_hint(row, cell_attributes())));
        }
    } else {
        figure.show = reader.texts("show", {});
        figure.errors = reader.boolean("errors", false);
    }
    reader.finish();
    return figure;
}

}  // namespace

bool Selector::matches(const Cell& cell) const {
    return std::ranges::all_of(wanted, [&](const auto& entry) {
        return std::ranges::find(entry.second, attribute_of(cell, entry.first)) != entry.second.end();
    });
}

Presentation parse_presentation(const ConfigValue& table, const std::filesystem::path& file) {
    ConfigReader reader(table, file.string());
    Presentation presentation;
    for (ConfigReader& figure : reader.tables("figures")) presentation.figures.push_back(read_figure(figure));
    for (ConfigReader& originals : reader.tables("originals"))
        presentation.originals.push_back(read_originals(originals));
    for (ConfigReader& claim : reader.tables("claims")) presentation.claims.push_back(read_claim(claim));
    return presentation;
}

}  // namespace plumb
