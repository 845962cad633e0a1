// Tells builds apart whose samples may differ.
#pragma once

#include <string_view>

namespace plumb {

// Over the source files that decide a reference's pixels: 16 hexadecimal digits.
std::string_view integrator_hash();

}  // namespace plumb
