#include "rasterizer/plane_history.h"

#include <algorithm>
#include <utility>

namespace plumb {

void PlaneHistory::trade_places() const {
    std::swap(*now_, *before_);
    if (views_of_now_) std::ranges::swap_ranges(*views_of_now_, *views_of_before_);
}

}  // namespace plumb
