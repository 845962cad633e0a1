#include "metrics/measure_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "frames/image_error.h"
#include "frames/parallel.h"

namespace plumb {
namespace {

template <std::size_t count>
std::array<BlockSeries, count> all_of_kind(SeriesOf kind) {
    std::array<BlockSeries, count> series;
    series.fill(BlockSeries(longest_run(kind)));
    return series;
}

std::vector<double> that_exist(const std::vector<double>& values) {
    std::vector<double> list;
    std::ranges::copy_if(values, std::back_inserter(list), [](double value) { return !std::isnan(value); });
    return list;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(values.size());
}

double over_series(std::string_view measure, const std::vector<double>& values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (measure == "maximum") return std::ranges::max(values);
    if (measure == "values" || measure == "left_out") return mean(values) * static_cast<double>(values.size());
    return mean(values);
}

}  // namespace

MeasureSeries::MeasureSeries(SeriesOf kind) : means_(all_of_kind<mean_measures.size()>(kind)) {
    for (const PercentileMeasure& percentile : percentile_measures)
        percentiles_.emplace_back(percentile.level, longest_run(kind));
}

void MeasureSeries::add(const PlaneComparison& comparison) {
    if (!comparison.blocks) throw ImageError("a series needs comparisons that keep their blocks");
    const MeasureBlocks& blocks = *comparison.blocks;
    for (std::size_t i = 0; i < mean_measures.size(); ++i) means_[i].add(blocks.*mean_measures[i].blocks);
    for (std::size_t i = 0; i < percentile_measures.size(); ++i)
        percentiles_[i].add(comparison.errors.*percentile_measures[i].value, blocks.below[i]);
    magnitudes_.average_in(blocks.magnitudes, members_);
    ++members_;
    const auto measures = comparison.measures();
    values_.resize(measures.size());
    names_.resize(measures.size());
    for (std::size_t i = 0; i < measures.size(); ++i) {
        names_[i] = measures[i].first;
        values_[i].push_back(measures[i].second);
    }
}

std::vector<double> MeasureSeries::values_of(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    return found == names_.end() ? std::vector<double>{}
                                 : that_exist(values_[static_cast<std::size_t>(found - names_.begin())]);
}

double MeasureSeries::peak() const {
    std::vector<double> squares = values_of("data_range");
    for (double& range : squares) range *= range;
    return std::sqrt(mean(squares));
}

std::vector<std::pair<std::string, double>> MeasureSeries::measures(const BootstrapSettings& settings) const {
    std::array<Estimate, mean_measures.size() + percentile_measures.size()> estimates;
    parallel_for(static_cast<int>(estimates.size()), [&](int i) {
        const auto place = static_cast<std::size_t>(i);
        estimates[place] = place < means_.size() ? means_[place].mean(settings)
                                                 : percentiles_[place - means_.size()].mean(magnitudes_, settings);
    });
    MeasureIntervals intervals;
    for (std::size_t i = 0; i < mean_measures.size(); ++i) {
        if (mean_measures[i].name != "mse") {
            intervals.set(std::string(mean_measures[i].name), estimates[i]);
            continue;
        }
        intervals.set_mse(estimates[i], peak());
    }
    for (std::size_t i = 0; i < percentile_measures.size(); ++i)
        intervals.set(std::string(percentile_measures[i].name), estimates[mean_measures.size() + i]);
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t i = 0; i < names_.size(); ++i)
        result.emplace_back(names_[i], over_series(names_[i], that_exist(values_[i])));
    intervals.replace_in(result);
    return result;
}

std::vector<std::pair<std::string, Estimate>> MeasureSeries::over_members() const {
    std::vector<std::pair<std::string, Estimate>> list;
    for (std::size_t i = 0; i < names_.size(); ++i) {
        // The mean of roots is not the root of the mean.
        const bool has_mean = has_interval(names_[i]) && names_[i] != "rmse" && !names_[i].starts_with("unbiased");
        if (has_mean) list.emplace_back(names_[i], student_mean(that_exist(values_[i])));
    }
    return list;
}

}  // namespace plumb
