// A method: every parameter of the real-time side that can change a pixel, and nothing else.
#pragma once

#include <limits>
#include <string>

namespace plumb {

enum class SourceOfStage { method, truth };  // truth: the stage's planes are handed in instead of rendered

// How the layers behind the first come about: each by a geometry pass of its own (peel), or the second in the pass of
// the first, after Mara et al. 2016 (one_pass_gbuffer.h says what each guarantees).
enum class LayerGeneration { peel, delay, previous, predict, reproject };
// What sends triangles to the layers of a single pass; a vertex shader needs GL_ARB_shader_viewport_layer_array.
enum class LayerSelection { geometry_shader, vertex_shader };
enum class SeparationUnit { metres, frustum };   // frustum: a fraction of the camera's far - near, after Nielsen 2015
enum class DepthMapping { reversed, standard };  // of the hardware's float depth: 1 to 0, or 0 to 1
// What the screen-space passes take a point from: depth, or a plane of its own, of floats or (stored_16) half floats.
enum class PositionSource { from_depth, stored, stored_16 };
// normal_encoding.h has the formulas; in bytes: 4, 2, 16, 8, 4, 4, 2.
enum class NormalFormat { oct32, oct16, rgb32f, rgb16f, rgb10a2, r11g11b10f, xy8 };
enum class RadianceFormat { rgba32f, rgba16f, r11g11b10f };  // in bytes: 16, 8, 4

// With everything else on, two layers of 1280x720 take less than 400 MiB of OpenGL's memory in any one of these
// formats; with several of the wide ones at once, or more than two bounces, they take more.
struct GBufferSettings {
    SourceOfStage source = SourceOfStage::method;
    int layers = 2;  // 1 to 4; more than 2 by peeling only, for who reads layer3.* and layer4.*
    LayerGeneration generation = LayerGeneration::peel;
    LayerSelection layer_selection = LayerSelection::geometry_shader;
    float minimum_separation = 0.1f;  // between the layers along the view axis
    SeparationUnit separation_unit = SeparationUnit::metres;
    int guard_band = 0;  // pixels rendered beyond each side of the view
    DepthMapping depth_mapping = DepthMapping::reversed;
    PositionSource position = PositionSource::from_depth;
    NormalFormat normal_format = NormalFormat::oct32;
    RadianceFormat radiance_format =
        RadianceFormat::rgba16f;  // of the lit layers that the radiosity and reflections gather from
};

// What holds the shadows of point lights, and of spot lights too wide for a flat map (shadow_pass.h compares them).
enum class PointShadowMap { cube, dual_paraboloid };
// six_views: one draw per face of what the face may see; one_pass: one draw, a geometry shader sends it to all faces.
enum class CubeGeneration { six_views, one_pass };
// What a cube keeps: near / (distance along the face's axis), or the distance itself divided by the scene's reach.
enum class CubeDistance { reciprocal, linear };

struct ShadowSettings {
    bool lamps = true;  // point and spot lights cast shadows; without, thousands of them fit into memory
    PointShadowMap point_map = PointShadowMap::cube;
    CubeGeneration cube_generation = CubeGeneration::six_views;
    CubeDistance cube_distance = CubeDistance::reciprocal;
    int cube_size = 1024;              // texels per face, point lights
    int paraboloid_size = 1024;        // texels per side of each of a light's two paraboloids
    int paraboloid_tessellation = 64;  // most segments that an edge is cut into, 1..64; 1: none
    int map_size = 2048;               // texels per side, spot and directional lights
    int pcf_radius = 0;                // texels: (2 r + 1)^2 comparisons are averaged in flat maps; 0: one, bilinear
    int emitter_size = 512;            // texels per face, emissive surfaces
    int emitter_samples = 1;  // points of an emissive surface whose visibility is averaged: 1 gives hard shadows
    float bias = 0.005f;      // metres that a receiver is lifted off its surface, besides what the texels call for
};

// How point and spot lights are shaded (light_volume_pass.h): every light at every pixel, or each within its volume.
enum class LocalLights { fullscreen, volume, volume_stencil };
// Which distance a volume's radius is: where the light falls to the threshold, or what OGLdev's code of tutorial 36
// comes to, which has the attenuation's quadratic term in the place of its constant one (light_volumes.h).
enum class VolumeRadius { attenuation, ogldev_code };
enum class VolumeFaces { front, back, both };  // which side of a volume is drawn where there is no stencil
// What gives the irradiance of the environment: spherical harmonics of order 2, or a cube (radiance_maps.h).
enum class EnvironmentIrradiance { harmonics, cube };

struct DirectSettings {
    SourceOfStage source = SourceOfStage::method;
    bool emitters = true;  // emissive surfaces light others here; without, only through radiosity.emitters_shine
    LocalLights local_lights = LocalLights::fullscreen;
    float volume_threshold = 1.0f / 256.0f;  // W / m^2 below which a light ends
    VolumeRadius volume_radius = VolumeRadius::attenuation;
    VolumeFaces volume_faces = VolumeFaces::back;
    EnvironmentIrradiance environment = EnvironmentIrradiance::harmonics;
    ShadowSettings shadow;
};

// The environment as cubes for later passes to read (environment_maps_pass.h).
struct EnvironmentSettings {
    int size = 128;     // texels per face and side of the radiance, a power of two from 32
    int samples = 256;  // directions per texel of the glossy levels, also of the probe's
};

// A light probe, captured by the rasterizer itself (probe_pass.h).
struct ProbeSettings {
    float x = 0.0f, y = 0.0f, z = 0.0f;  // metres, world space
    int size = 64;                       // texels per face and side, a power of two from 32
    bool every_frame = false;            // captured anew for each frame, for lights and objects that move
};

// Which differences keep a neighbour from being blurred in (bilateral_blur.h has the formulas): depth, normal and
// tangent plane; or, after Nielsen 2015, depth alone, as the thesis' text has it or as its listing does.
enum class BlurKind { bilateral, gaussian_2015, gaussian_2015_listing };

// How much a neighbour counts over its distance in pixels, of kind `bilateral`: a Gaussian for any radius, or the
// tables that G3D has for radii up to 6.
enum class BlurWeights { gaussian, g3d };

// The separable filter that smooths the noise of few taps along surfaces.
struct BilateralBlurSettings {
    BlurKind kind = BlurKind::bilateral;
    int radius = 4;  // taps to each side; 0: no filter
    int step = 1;    // pixels between taps
    BlurWeights weights = BlurWeights::gaussian;
    float depth_sharpness = 10;  // relative to the filtered quantity's radius: 10 rejects depths a tenth of it away
    float normal_sharpness = 1;  // 1 rejects normals 90 degrees apart, 40 those 13 degrees apart
    float plane_sharpness = 1;   // rejects points off the centre's tangent plane...
    float plane_exemption = 0;   // ...but none whose squared distance is less, in square metres
    bool monotonic = true;       // a weight never rises again beyond an edge
    int depth_key_bits = 32;     // 8, 16: depths are compared as fractions of the far plane of so many bits
};

// From what the surfaces of the frame before are measured that a point may be found on (temporal_filter.h): the plane
// through the point, or, as Mara et al. 2016 and their code have it, the point itself.
enum class HistoryRejection { plane, mara2016 };

// What a pass takes over from the frame before, reprojected (temporal_filter.h has the formula).
struct TemporalFilterSettings {
    float alpha = 0.0f;  // weight of the frame before; 0: no filter
    HistoryRejection rejection = HistoryRejection::plane;
    float reject_from = 0.05f;  // metres that a point may be from where it is looked for, before its weight falls...
    float reject_to = 0.07f;    // ...until nothing is left here; as reject_from: a hard cut
    int layers = 1;             // 2: the second layer of the frame before may hold the point as well
    bool vary_taps = true;      // other taps in each frame: without, the filter averages one and the same noise
};

// How taps spiral around a pixel (sample_spiral.h): as in the code of McGuire, Mara, Luebke 2012 and Mara et al. 2016,
// or as in Nielsen's thesis.
enum class TapPattern { sao2012, nielsen2015 };

// Where the point of a tap lies that reads a coarser level: where the pixel has it whose depth the texel holds
// (depth_mip_chain.h), or, as the code of McGuire, Mara, Luebke 2012 has it, as deep as that at the tap's own position.
enum class MipTapPoint { exact, sao2012 };

// Which formula turns taps into ambient visibility; each is named after its source (ambient_obscurance.h has them).
enum class AmbientObscuranceEstimator {
    mara2016,
    g3d_demo,
    sao2012,
    sao2012_undivided,
    alchemy2011,
    nielsen2015,
    linear
};
// Which normal the hemisphere stands on: the surface's own, or that of the face through the neighbouring pixels'
// points, which are chosen with care, or as the code shipped with G3D does (ambient_obscurance.h).
enum class ObscuranceNormals { interpolated, face, g3d_demo };

struct AmbientObscuranceSettings {
    bool enabled = true;
    AmbientObscuranceEstimator estimator = AmbientObscuranceEstimator::mara2016;
    int samples = 16;  // taps per pixel, 1..1000
    TapPattern pattern = TapPattern::sao2012;
    int layers = 2;  // 1 or 2, at most those of the G-buffer
    ObscuranceNormals normals = ObscuranceNormals::interpolated;
    float bias = 0.01f;      // metres; hides self-occlusion on flat surfaces (of alchemy2011, nielsen2015: see there)
    float epsilon = 0.001f;  // square metres; keeps the division by the tap's distance finite
    float intensity = 1.0f;
    float exponent = 1.0f;      // of the visibility; alchemy2011 and nielsen2015 only
    int spread_pixels = 0;      // the taps spread over so many pixels; 0: over the radius as it projects
    bool use_mip_chain = true;  // reads coarser depth for far taps: constant cost over radius
    int mip_offset = 3;         // a tap r' pixels away reads level floor(log2 r') - mip_offset
    MipTapPoint mip_points = MipTapPoint::exact;
    BilateralBlurSettings blur = {};
    TemporalFilterSettings temporal = {};  // after the blur
};

// How taps are counted and layers added; each is named after its source (radiosity_gather.h has the formulas).
enum class RadiosityEstimator { mara2016, nielsen2015 };
// What the sum over the taps is divided by: the taps that hit (as the paper), or all of them.
enum class RadiosityNormalisation { hits, samples };
// Where the indirect light comes from that the second layer reflects: what the first layer receives at the same pixel,
// a gather at the second layer's own points, or nowhere.
enum class SecondLayerIndirect { reuse, gather, none };
// What stands in for light that no tap finds: a constant radiance, or the irradiance of the environment or the probe.
enum class AmbientSource { none, ambient, environment, probe };

constexpr int most_bounces = 8;  // within a frame

struct RadiositySettings {
    bool enabled = true;
    RadiosityEstimator estimator = RadiosityEstimator::mara2016;
    int samples = 32;  // taps per pixel, 1..1000
    TapPattern pattern = TapPattern::sao2012;
    int layers = 2;               // 1 or 2, at most those of the G-buffer
    bool emitters_shine = false;  // taps also carry what their surface emits: see radiosity.h
    float radius = 1.0f;          // metres
    int spread_pixels = 0;        // the taps spread over so many pixels; 0: over the radius as it projects
    bool test_tap_normal = true;  // taps must face the receiver
    RadiosityNormalisation normalisation = RadiosityNormalisation::hits;
    bool use_mip_chain = true;
    int mip_offset = 4;         // a tap r' pixels away reads level floor(log2 r') - mip_offset
    int minimum_mip_level = 0;  // 0..5; higher is faster and noisier
    MipTapPoint mip_points = MipTapPoint::exact;
    bool mip_normals_and_radiance = false;  // far taps read these from chains, too: the same light, other memory
    int bounces = 1;                        // within a frame, 1..most_bounces; each takes planes of its own
    SecondLayerIndirect second_layer = SecondLayerIndirect::reuse;  // for later bounces
    bool carry = false;              // one bounce a frame, on top of those of the frames before (radiosity_carry.h)
    float damping = 0.0f;            // the fraction of what is carried on that is taken away, 0..1
    float carry_from = 0.04f;        // metres between a point and where it is found again: from here on less
    float carry_to = 0.06f;          // is carried on, and from here on nothing
    float saturated_boost = 1.0f;    // factor of what is reflected of indirect light of pure colours; 1: energy stays
    float unsaturated_boost = 1.0f;  // the same of greys
    AmbientSource fill = AmbientSource::none;  // mixed in where few taps hit (radiosity_sum.h)
    float ambient = 0.1f;                      // W / (m^2 sr), the constant radiance of fill = "ambient"
    BilateralBlurSettings blur = {.depth_sharpness = 0, .normal_sharpness = 40, .plane_sharpness = 0.5f};
    TemporalFilterSettings temporal = {};  // after the blur
};

// How wide the specular lobe is taken to be (reflections.h): one ray for all of it; one ray that reads a blurred image
// by the lobe's footprint; or rays spread over it.
enum class ReflectionRoughness { mirror, mip, samples };
// Where a ray hits a layer: up to `thickness` behind it, as a surface that thick would be; or, as Mara et al. 2016 have
// it, no farther than that from it, on either side; or behind it, and also where it went from before the layer to
// behind it, however far, between two looks.
enum class ReflectionHit { behind, mara2016, crossed };
// What is reflected where a ray finds nothing or leaves the view.
enum class ReflectionFallback { none, environment, probe };

struct ReflectionSettings {
    bool enabled = false;
    ReflectionRoughness roughness = ReflectionRoughness::mip;
    int samples = 16;          // rays per pixel, 1..4096; where roughness is `samples`
    int layers = 2;            // 1 or 2, at most those of the G-buffer
    float step = 2.0f;         // pixels between two looks along a ray
    float first_step = 1.0f;   // pixels to the first one
    int max_steps = 512;       // looks along a ray
    int refinement_steps = 4;  // halvings of the step in which a ray passed behind a surface
    ReflectionHit hit = ReflectionHit::behind;
    float thickness = 0.0f;  // metres that surfaces are taken to be thick; 0: the G-buffer's minimum separation
    float max_distance = std::numeric_limits<float>::infinity();  // metres
    float bias = 0.005f;          // metres that a hit must rise above the reflecting point's tangent plane
    bool test_hit_normal = true;  // what is hit must face the ray
    int border_fade = 16;         // pixels from the image's border over which hits give way to the fallback
    ReflectionFallback fallback = ReflectionFallback::none;
    bool lamps = true;  // point, spot and directional lights have highlights
};

// How the resolved image is looked up between its pixels: bilinear smooths what moves, Catmull-Rom hardly does.
enum class HistoryLookup { bilinear, catmull_rom };

// Anti-aliasing over frames, each of which is rendered with its pixels moved by a part of one (temporal_antialias.h).
struct AntialiasSettings {
    bool temporal = false;
    int jitter_length = 8;     // frames until the offsets repeat
    bool reprojection = true;  // the frames before are looked up where the surface then was; else at the same pixel
    float alpha = 0.9f;        // their most weight
    bool dilate = true;        // motion is that of the nearest surface among the neighbours: edges move as one
    HistoryLookup lookup = HistoryLookup::catmull_rom;
    bool clamp = true;  // they are held within the colours of the neighbouring pixels
};

// How the terms become `total` (composite_pass.h): added, or as the demo of Mara et al. shows them.
enum class CompositeKind { physical, demo };

struct CompositeSettings {
    CompositeKind kind = CompositeKind::physical;
    AmbientSource fill = AmbientSource::none;  // where the ambient light of the demo's comes from
    float ambient = 0.1f;                      // W / (m^2 sr), the constant radiance of fill = ambient
};

// Radius and falloff of ambient visibility are not here: they belong to the quantity that is asked for (Quantities).
struct Method {
    std::string name = "default";
    GBufferSettings gbuffer;
    DirectSettings direct;
    EnvironmentSettings environment;
    ProbeSettings probe;
    AmbientObscuranceSettings ao;
    RadiositySettings radiosity;
    ReflectionSettings reflections;
    CompositeSettings composite;
    AntialiasSettings antialias;
};

}  // namespace plumb
