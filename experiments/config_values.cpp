#include "experiments/config_values.h"

#include "frames/image_error.h"

namespace plumb {

void read_falloff(ConfigReader& reader, const char* key, Falloff& falloff) {
    try {
        falloff = falloff_from_string(reader.text(key, std::string(to_string(falloff))));
    } catch (const ImageError& error) {
        reader.fail(key, error.what());
    }
}

void read_resolution(ConfigReader& reader, int& width, int& height) {
    const std::vector<int> size = reader.integers("resolution", {width, height}, 1, 16384);
    if (size.size() != 2) reader.fail("resolution", "must be [width, height]");
    width = size[0], height = size[1];
}

void allow_presentation(ConfigReader& reader) {
    for (const char* key : {"figures", "originals", "claims"}) reader.value(key);
}

}  // namespace plumb
