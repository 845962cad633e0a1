// What an experiment makes of its results, never of its pixels: the tables [[figures]], [[originals]] and [[claims]] of
// its file. (experiments/reproduce/*.toml are examples.)
//
//     [[claims]]
//     claim = "Two layers cost almost double to generate."
//     source = "000, section 4.1.1"                      # where it stands
//     test = "Time of the geometry passes, two layers over one"
//     measure = "ms of gbuffer*"                         # measured_cells.h has the names
//     ratio = [{ method = "two layers" }, { method = "one layer" }]
//     where = { plane = "indirect" }
//     above = 1.6                                        # it holds where the interval lies above this...
//     below = 2.2                                        # ...and below that
//
// A quantity is one of
//     value = {}                  the measure itself, averaged over the selected cells
//     ratio = [{...}, {...}]      of two cells that differ in nothing but what the selectors name; geometric mean
//     difference = [{...}, {...}] the same, subtracted
//     slope = { curve = "..." }   of log measure over log parameter along a curve, one for each view
// A selector names attributes of cells (scene, place, plane, truth, method, curve, parameter) with one value or
// several.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config.h"
#include "experiments/measured_cells.h"

namespace plumb {

// Cells by their attributes; an attribute that it does not name may be anything.
struct Selector {
    std::map<std::string, std::vector<std::string>, std::less<>> wanted;

    bool names(std::string_view attribute) const { return wanted.find(attribute) != wanted.end(); }
    bool matches(const Cell& cell) const;
};

enum class QuantityKind { value, ratio, difference, slope };

struct MeasuredQuantity {
    std::string measure;
    QuantityKind kind = QuantityKind::value;
    Selector where;          // of all cells that are looked at
    Selector first, second;  // of ratios and differences: first to second; of others: first alone
};

// What a seed says that can be checked.
struct Claim {
    std::string claim, source, test;
    MeasuredQuantity quantity;
    std::string unit;                    // behind the figure, " ms"
    std::optional<double> above, below;  // at least one: where the claim holds
};

struct OriginalRow {
    std::string name;
    double original = 0.0;
    Selector of;
    std::string over;  // the row that it is divided by; empty: none
};

// Numbers that a seed prints. Their machine is not ours, so that ratios of two rows are compared.
struct Originals {
    std::string title, source, measure, unit;
    Selector where;
    std::vector<OriginalRow> rows;
};

enum class FigureKind { curves, bars, table, pictures };

struct Figure {
    std::string title, source;
    FigureKind kind = FigureKind::curves;
    Selector where;
    std::string x = "parameter";  // curves: "parameter" or a measure; bars: the attribute with one group for each value
    std::string y = "rmse";       // a measure
    std::string series;           // the attribute with one colour for each value
    std::string panels;           // the attribute with one panel for each value; empty: one panel
    // Not empty: y is not the measure but its ratio to that of the cell that this selects, with intervals.
    Selector relative_to;
    std::string x_label, y_label;
    bool linear_x = false, linear_y = false;  // else logarithmic
    std::vector<std::string> rows, columns;   // tables: attributes and measures
    std::vector<std::string> show;            // pictures: the labels in this order ("truth", methods)
    bool errors = false;                      // pictures: the error maps below
};

struct Presentation {
    std::vector<Figure> figures;
    std::vector<Originals> originals;
    std::vector<Claim> claims;
};

// `table` is the whole file; keys of other readers are left alone. Throws ConfigError with file and line.
Presentation parse_presentation(const ConfigValue& table, const std::filesystem::path& file);

}  // namespace plumb
