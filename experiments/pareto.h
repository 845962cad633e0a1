// Error over milliseconds: which methods nobody beats in both, and what the path tracer makes of the same time or needs
// for the same error.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace plumb {

struct CostPoint {
    double milliseconds = 0.0, error = 0.0;  // both positive
};

// Indices of the points that no other is better than in one and at least as good in the other, by rising time. Of equal
// points the first.
std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points);

struct CurveReading {
    double value = 0.0;
    bool extrapolated = false;  // beyond the curve's first or last point
};

// A curve of points, such as the path tracer's over its samples. Between two points, log error is linear in log time
// (Monte Carlo errors are powers of time); beyond the ends the nearest segment goes on.
class CostCurve {
public:
    explicit CostCurve(std::vector<CostPoint> points);

    // Nothing where there are fewer than two points or all have the same time (or, of the second, the same error).
    std::optional<CurveReading> error_at(double milliseconds) const;
    std::optional<CurveReading> milliseconds_at(double error) const;

private:
    std::vector<CostPoint> points_;  // by rising time
};

}  // namespace plumb
