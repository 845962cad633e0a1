// Curves through keys in time: what camera paths and moving objects share.
//
// A key is any struct with a member `time` (seconds). Before the first key and after the last a curve stands still.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scenes/scene_error.h"

namespace plumb {

// Throws SceneError "`what`: ..." where the times do not increase.
template <typename Key>
void check_key_times(const std::vector<Key>& keys, std::string_view what) {
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (!(keys[i].time > keys[i - 1].time)) {
            throw SceneError(fmt::format("{}: key {} at {} s does not come after key {} at {} s", what, i, keys[i].time,
                                         i - 1, keys[i - 1].time));
        }
    }
}

// The two keys around a time; the same one twice where there is but one.
template <typename Real>
struct BasicKeySpan {
    std::size_t from = 0, to = 0;
    Real duration = 0;  // seconds between them
    Real s = 0;         // 0 at `from`, 1 at `to`
};
using KeySpan = BasicKeySpan<float>;

template <typename Key, typename Real>
BasicKeySpan<Real> find_key_span(const std::vector<Key>& keys, Real time) {
    const Real t = std::clamp<Real>(time, keys.front().time, keys.back().time);
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), t, [](Real value, const Key& key) { return value < key.time; });
    const std::size_t last = keys.size() - 1;
    BasicKeySpan<Real> span;
    span.from = std::min<std::size_t>(after - keys.begin() - 1, last == 0 ? 0 : last - 1);
    span.to = std::min(span.from + 1, last);
    span.duration = keys[span.to].time - keys[span.from].time;
    span.s = span.duration > 0 ? (t - keys[span.from].time) / span.duration : Real(0);
    return span;
}

// Catmull-Rom curve through value(key): a cubic Hermite curve whose tangent at a key is the slope between its
// neighbours (at the ends: to its only neighbour), scaled to the keys' times, so that the speed is continuous.
template <typename Key, typename Real, typename Value>
auto catmull_rom(const std::vector<Key>& keys, const BasicKeySpan<Real>& span, Value value) {
    using Point = decltype(value(keys.front()));
    const std::size_t last = keys.size() - 1;
    const auto tangent = [&](std::size_t i) {
        const std::size_t before = i == 0 ? 0 : i - 1, next = std::min(i + 1, last);
        if (before == next) return Point(Real(0));
        return (value(keys[next]) - value(keys[before])) / static_cast<Real>(keys[next].time - keys[before].time);
    };
    const Point p1 = value(keys[span.from]), m1 = tangent(span.from);
    const Point p2 = value(keys[span.to]), m2 = tangent(span.to);
    const Real s = span.s, s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * p1 + (s3 - 2 * s2 + s) * span.duration * m1 + (3 * s2 - 2 * s3) * p2 +
           (s3 - s2) * span.duration * m2;
}

}  // namespace plumb
