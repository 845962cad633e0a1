#pragma once

#include <limits>

namespace plumb {

// Stands where a measure does not apply; tables print "-", JSON null.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace plumb
