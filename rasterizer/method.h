// A method: every parameter of the real-time side that can change a pixel, and nothing else.
#pragma once

#include <string>

namespace plumb {

enum class SourceOfStage { method, truth };  // truth: the stage's planes are handed in instead of rendered

struct GBufferSettings {
    SourceOfStage source = SourceOfStage::method;
    int layers = 2;                   // 1 or 2
    float minimum_separation = 0.1f;  // metres between the layers along the view axis
    int guard_band = 0;               // pixels rendered beyond each side of the view
};

struct ShadowSettings {
    int cube_size = 1024;  // texels per face, point lights
    int map_size = 2048;   // texels per side, spot and directional lights
    float bias = 0.005f;   // metres
};

struct DirectSettings {
    SourceOfStage source = SourceOfStage::method;
    ShadowSettings shadow;
};

struct AmbientObscuranceSettings {
    bool enabled = true;
    int samples = 16;          // taps per pixel, 1..1000
    int layers = 2;            // 1 or 2, at most those of the G-buffer
    float bias = 0.01f;        // metres; hides self-occlusion on flat surfaces
    bool use_mip_chain = true; // reads coarser depth for far taps: constant cost over radius
    float intensity = 1.0f;
    int blur_radius = 4;       // taps to each side of the separable bilateral filter; 0: none
};

struct RadiositySettings {
    bool enabled = true;
    int samples = 32;          // taps per pixel
    int layers = 2;
    float radius = 1.0f;       // metres
    bool test_tap_normal = true;  // taps must face the receiver
    bool use_mip_chain = true;
    int blur_radius = 4;
};

// Radius and falloff of ambient visibility are not here: they belong to the quantity that is asked for (Quantities).
struct Method {
    std::string name = "default";
    GBufferSettings gbuffer;
    DirectSettings direct;
    AmbientObscuranceSettings ao;
    RadiositySettings radiosity;
};

}  // namespace plumb
