// Texts of small mesh files that tests write.
#pragma once

#include <string>

namespace plumb {

inline const char* const triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// One triangle (0,0,0) (1,0,0) (0,1,0), a camera, a light of each kind, an emitter, a mirrored node.
inline std::string gltf(
    const std::string& material =
        R"("emissiveFactor":[1,0.5,0.25],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}})") {
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual","KHR_materials_emissive_strength","NV_materials_mdl"],
"extensions":{"KHR_lights_punctual":{"lights":[
  {"type":"spot","color":[1,0.5,0.25],"intensity":10,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6},"name":"spot"},
  {"type":"point","intensity":7},{"type":"directional","intensity":3}]}},
"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"aspectRatio":1.5,"znear":0.1,"zfar":50}}],
"materials":[{"name":"m",)" +
           material + R"(}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"nodes":[{"mesh":0,"translation":[1,2,3]},{"camera":0,"name":"eye","translation":[0,0,5]},
  {"extensions":{"KHR_lights_punctual":{"light":0}},"name":"spot","rotation":[-0.70710678,0,0,0.70710678],"translation":[0,3,0]},
  {"extensions":{"KHR_lights_punctual":{"light":1}},"name":"bulb","translation":[4,0,0]},
  {"extensions":{"KHR_lights_punctual":{"light":2}},"name":"sun"},
  {"mesh":0,"name":"mirrored","scale":[-1,1,1]}],
"scenes":[{"nodes":[0,1,2,3,4,5]}],"scene":0})";
}

}  // namespace plumb
