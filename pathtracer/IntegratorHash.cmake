# Script behind integrator_hash.cpp: writes OUTPUT anew where a file that decides a reference's pixels has changed since
# the last build.

# What a scene file becomes is in the scene's content hash; here is what turns a scene into radiance.
file(GLOB sources ${SOURCE_DIR}/pathtracer/*.cpp ${SOURCE_DIR}/pathtracer/*.h ${SOURCE_DIR}/frames/quantities.*
     ${SOURCE_DIR}/scenes/bilinear_lookup.* ${SOURCE_DIR}/scenes/camera.* ${SOURCE_DIR}/scenes/ggx.*
     ${SOURCE_DIR}/scenes/keyed_curve.* ${SOURCE_DIR}/scenes/light.* ${SOURCE_DIR}/scenes/material.*
     ${SOURCE_DIR}/scenes/motion.*
     ${SOURCE_DIR}/scenes/scene.* ${SOURCE_DIR}/scenes/specular_albedo.* ${SOURCE_DIR}/scenes/surface_sample.*
     ${SOURCE_DIR}/scenes/texture.*)
list(FILTER sources EXCLUDE REGEX "/benchmark_[^/]*$")
list(SORT sources)
set(hashes "")
foreach(file ${sources})
    file(SHA256 ${file} hash)
    string(APPEND hashes ${hash})
endforeach()
string(SHA256 integrator "${hashes}")
string(SUBSTRING ${integrator} 0 16 integrator)

file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#include "pathtracer/integrator_hash.h"

namespace plumb {

std::string_view integrator_hash() { return "@integrator@"; }

}  // namespace plumb
]] @ONLY)
