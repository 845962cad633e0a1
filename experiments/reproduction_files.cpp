#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/claims_report.h"
#include "experiments/figures.h"
#include "experiments/reproduction.h"
#include "experiments/svg_raster.h"
#include "experiments/svg_table.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

// As a sentence, with a space before it; empty where a verdict needs no reason.
std::string reason_text(const ClaimRecord& record) {
    if (record.reason.empty()) return "";
    if (record.verdict == to_string(ClaimVerdict::depends)) return fmt::format(" It depends {}.", record.reason);
    return fmt::format(" It {}: {}.",
                       record.verdict == to_string(ClaimVerdict::undecided) ? "was not decided" : "could not be tested",
                       record.reason);
}

// What a result that has gone stale is known by.
std::string key_text(const Measurements& measurements) {
    return fmt::format("Program {}; key `{}`, which another file, scene, method or program would change.",
                       measurements.program.empty() ? "unknown" : measurements.program,
                       measurements.key.empty() ? "unknown" : measurements.key);
}

// Writes the files of one reproduction and gathers what its README.md and the terminal show.
class Presenter {
public:
    Presenter(const Reproduction& reproduction, const Measurements& measurements, const std::filesystem::path& folder)
        : reproduction_(reproduction), measurements_(measurements), folder_(folder) {}

    PresentedReproduction run() {
        write("measurements.json", print_measurements_json(measurements_));
        write("numbers.csv", print_cells_csv(measurements_.cells));
        readme_ = fmt::format("# {}\n\n{}\n\nMakes again: {}.\n", reproduction_.title, reproduction_.question,
                              fmt::join(reproduction_.sources(), "; "));
        if (measurements_.quick) add_text("This was a trial run (--quick): its figures prove nothing.");
        for (const std::string& scene : measurements_.left_out) add_text(fmt::format("Left out: {}", scene));
        for (std::size_t i = 0; i < reproduction_.drawings.size(); ++i) add_drawing(i);
        for (std::size_t i = 0; i < reproduction_.presentation.figures.size(); ++i) add_figure(i);
        for (std::size_t i = 0; i < reproduction_.presentation.originals.size(); ++i) add_originals(i);
        add_claims();
        add_facts();
        write("README.md", readme_);
        return std::move(presented_);
    }

private:
    void write(const std::string& name, const std::string& content) {
        write_text_atomically(folder_ / name, content);
        presented_.files.push_back(folder_ / name);
    }

    void add_text(const std::string& sentence) {
        readme_ += fmt::format("\n{}\n", sentence);
        presented_.text += sentence + "\n";
    }

    void add_heading(const std::string& title, const std::string& source) {
        readme_ += fmt::format("\n## {}\n\n{}", title, source.empty() ? "" : fmt::format("After {}.\n\n", source));
    }

    void add_table(const std::string& title, const std::string& source, const std::string& name,
                   const ResultTable& table) {
        add_heading(title, source);
        readme_ += table.print_markdown();
        presented_.text += fmt::format("\n{}\n{}", title, table.print_text());
        const std::string svg = print_svg_table(table, title);
        write(name + ".svg", svg);
        write(name + ".png", rasterise_svg(svg));
        write(name + ".csv", table.print_csv());
    }

    void add_drawing(std::size_t index) {
        const Drawing& drawing = reproduction_.drawings[index];
        const std::string name = fmt::format("figure-{}", index + 1), svg = print_drawing(drawing);
        add_heading(drawing.title, drawing.source);
        readme_ += fmt::format("![{}]({}.png)\n", drawing.title, name);
        write(name + ".svg", svg);
        write(name + ".png", rasterise_svg(svg));
        write(name + ".csv", drawing_numbers(drawing).print_csv());
    }

    void add_figure(std::size_t index) {
        const Figure& figure = reproduction_.presentation.figures[index];
        const std::string name = fmt::format("figure-{}", index + 1);
        if (figure.kind == FigureKind::table) {
            add_table(figure.title, figure.source, name, make_table(figure, measurements_.cells));
            return;
        }
        const bool is_chart = figure.kind != FigureKind::pictures;
        const std::string svg = is_chart ? print_chart(figure, measurements_.cells)
                                         : print_picture_sheet(figure, measurements_.pictures, folder_ / "run");
        if (svg.empty()) {
            add_text(fmt::format("{}: nothing was measured that it could show.", figure.title));
            return;
        }
        add_heading(figure.title, figure.source);
        readme_ += fmt::format("![{}]({}.png)\n", figure.title, name);
        write(name + ".svg", svg);
        // Photographs are as large as they are; lines are drawn finely.
        write(name + ".png", rasterise_svg(svg, is_chart ? 2.0 : 1.0));
        const ResultTable numbers = is_chart ? chart_numbers(figure, measurements_.cells)
                                             : picture_numbers(figure, measurements_.pictures, measurements_.cells);
        write(name + ".csv", numbers.print_csv());
    }

    void add_originals(std::size_t index) {
        const Originals& originals = reproduction_.presentation.originals[index];
        add_table(originals.title, originals.source, fmt::format("originals-{}", index + 1),
                  make_originals_table(originals, measurements_.cells));
        readme_ +=
            "\nThe original's machine is not ours: 'here / original' says how far they are apart, and is alike in all "
            "rows where times behave as in the original. Where a row names another in 'over', the two columns behind "
            "it "
            "are the ratio of the two, in the original and here, with the 95 % interval over views.\n";
    }

    void add_claims() {
        if (reproduction_.presentation.claims.empty()) return;
        std::vector<ClaimRecord> records;
        for (const Claim& claim : reproduction_.presentation.claims) {
            ClaimResult result = judge_claim(claim, measurements_.cells);
            result.experiment = reproduction_.name;
            records.push_back(record_of(result, measurements_.quick, measurements_.key));
            presented_.claims.push_back(std::move(result));
        }
        write("claims.json", print_claims_json(presented_.claims, measurements_.quick, measurements_.key));
        add_heading("Claims", "");
        for (const ClaimRecord& record : records) {
            readme_ += fmt::format("- **{}** {} ({}) {}: {}, has to be {}.{}\n", record.verdict, record.claim,
                                   record.source, record.test, record.measured, record.range, reason_text(record));
        }
        presented_.text += "\n" + print_claims_text(records);
    }

    void add_facts() {
        if (measurements_.cells.empty()) return;
        add_heading("How it was measured", "");
        readme_ +=
            fmt::format("`{}`, {}, {} on {}, {:.0f} s. `numbers.csv` holds every number.\n", measurements_.command,
                        measurements_.started, measurements_.renderer, measurements_.cpu, measurements_.seconds);
        add_text(key_text(measurements_));
        for (const CellFailure& failure : measurements_.failures)
            add_text(fmt::format("Failed: {}: {}", failure.cell, failure.message));
    }

    const Reproduction& reproduction_;
    const Measurements& measurements_;
    const std::filesystem::path& folder_;
    PresentedReproduction presented_;
    std::string readme_;
};

}  // namespace

PresentedReproduction present(const Reproduction& reproduction, const Measurements& measurements,
                              const std::filesystem::path& folder) {
    return Presenter(reproduction, measurements, folder).run();
}

}  // namespace plumb
