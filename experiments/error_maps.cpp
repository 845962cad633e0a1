#include "experiments/error_maps.h"

#include "experiments/picture_look.h"
#include "frames/picture.h"
#include "metrics/error_image.h"

namespace plumb {

void write_error_map(const std::filesystem::path& file, const Image& test, const Image& reference, double scale) {
    const Image error = mean_of_channels(absolute_error(test, reference));
    write_png(file, apply_colour_map(error, error_colour_map, 0.0f, static_cast<float>(scale)));
}

double error_map_scale(double error) { return error > 0.0 ? round_up_scale(error) : 1.0; }

}  // namespace plumb
