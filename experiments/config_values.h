// Values of experiment files that every kind of experiment reads alike.
#pragma once

#include "experiments/config.h"
#include "frames/quantities.h"

namespace plumb {

// Replaces `falloff` where the key is there. Throws ConfigError that lists the names.
void read_falloff(ConfigReader& reader, const char* key, Falloff& falloff);
// Replaces both by `resolution = [width, height]` where it is there.
void read_resolution(ConfigReader& reader, int& width, int& height);
// Makes the reader take the tables of presentation.h for known, which parse_presentation reads from the same file.
void allow_presentation(ConfigReader& reader);

}  // namespace plumb
