#include "experiments/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plumb {
namespace {

// Where the line through a and b, both axes logarithmic, has y at x.
double read_line(double x, double ax, double ay, double bx, double by) {
    const double share = std::log(x / ax) / std::log(bx / ax);
    return ay * std::pow(by / ay, share);
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        if (points[a].milliseconds != points[b].milliseconds) return points[a].milliseconds < points[b].milliseconds;
        return points[a].error < points[b].error;
    });
    std::vector<std::size_t> front;
    double least_error = std::numeric_limits<double>::infinity();
    for (const std::size_t index : order) {
        if (points[index].error >= least_error) continue;
        least_error = points[index].error;
        front.push_back(index);
    }
    return front;
}

CostCurve::CostCurve(std::vector<CostPoint> points) : points_(std::move(points)) {
    std::erase_if(points_, [](const CostPoint& point) { return !(point.milliseconds > 0.0) || !(point.error > 0.0); });
    std::ranges::stable_sort(points_, {}, &CostPoint::milliseconds);
}

std::optional<CurveReading> CostCurve::error_at(double milliseconds) const {
    std::vector<CostPoint> distinct = points_;
    const auto takes_as_long = [](const CostPoint& a, const CostPoint& b) { return a.milliseconds == b.milliseconds; };
    distinct.erase(std::unique(distinct.begin(), distinct.end(), takes_as_long), distinct.end());
    if (distinct.size() < 2) return std::nullopt;
    std::size_t next = 1;
    while (next + 1 < distinct.size() && distinct[next].milliseconds < milliseconds) ++next;
    const CostPoint &a = distinct[next - 1], &b = distinct[next];
    const bool outside = milliseconds < distinct.front().milliseconds || milliseconds > distinct.back().milliseconds;
    return CurveReading{read_line(milliseconds, a.milliseconds, a.error, b.milliseconds, b.error), outside};
}

std::optional<CurveReading> CostCurve::milliseconds_at(double error) const {
    if (points_.size() < 2) return std::nullopt;
    const auto read = [&](const CostPoint& a, const CostPoint& b) {
        return read_line(error, a.error, a.milliseconds, b.error, b.milliseconds);
    };
    // The first segment that crosses it: the least time that reaches the error.
    for (std::size_t i = 1; i < points_.size(); ++i) {
        const CostPoint &a = points_[i - 1], &b = points_[i];
        if (a.error != b.error && std::min(a.error, b.error) <= error && error <= std::max(a.error, b.error))
            return CurveReading{read(a, b), false};
    }
    const bool before = error > points_.front().error;
    const CostPoint& a = before ? points_[0] : points_[points_.size() - 2];
    const CostPoint& b = before ? points_[1] : points_.back();
    // A curve that does not fall there reaches no other error.
    if (!(a.error > b.error)) return std::nullopt;
    return CurveReading{read(a, b), true};
}

}  // namespace plumb
