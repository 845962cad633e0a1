// The taps of the screen-space passes: N points on a spiral around a pixel, spun by a hash of the pixel.
//
// Tap i of N lies at the fraction alpha = (i + jitter) / N of the disc's radius and at alpha tau(N) turns plus the
// pixel's spin. tau(N) is the number of turns that spreads N taps evenly over the disc. The patterns differ in the
// rest:
//
//     sao2012      jitter one half (ambient obscurance), or from pixel to pixel between 0.1 and 0.9 (radiosity);
//                  spin(x, y) = 10 ((3 x) xor (y + x y)) radians
//     nielsen2015  jitter 0.5 / tau(N); spin: a random number for each pixel, even in [0, 2 pi): there from a texture
//                  of them, here an integer hash of the pixel
//
//   Sources: McGuire, Mara, Luebke 2012, "Scalable Ambient Obscurance"; tau, hash and jitter: its authors' public code;
//   Nielsen 2015, bachelor's thesis, Technical University of Denmark, listings 3.27 and 3.30.
//
// Every driver must take the very same taps, so nothing here rests on a driver's sine: directions come from tables made
// on the CPU, and a pixel picks its spin by integer arithmetic, in units of 2^-32 turns that wrap around as the circle
// does (jitters are whole numbers of 2^-16, rounded down):
//
//     turn of tap  = (i / N) tau  +  quantise(spin + jitter tau / N + frame 0.618...)
//
// quantise rounds down to 1/1024 turn. The last term is there where taps vary in time: `frame` counts from the last
// cut, and the golden ratio's fraction spreads the turns of any number of successive frames evenly (the source adds the
// time in radians, which repeats nothing but depends on when a program was started). Pixels count from the bottom left,
// as OpenGL's do. A seed other than 0 moves the pattern: a pixel takes the spin and the jitter of another one, so far
// away that they have nothing in common. sample_spiral.glsl is the other half.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "rasterizer/gl_objects.h"
#include "rasterizer/method.h"
#include "rasterizer/shader.h"

namespace plumb {

constexpr int maximum_spiral_samples = 1000;
constexpr int spiral_spin_bits = 10;
constexpr int spiral_spin_count = 1 << spiral_spin_bits;

// tau(N), for N = 1..maximum_spiral_samples. Throws MethodError that names the range.
int spiral_turns(int samples);

// How far `seed` moves the pattern, in pixels: less than 2^15, not at all for 0.
glm::ivec2 pattern_shift(std::uint32_t seed);

// The tables that the shader reads, as a uniform block of layout std140; OpenGL guarantees 16384 bytes for one.
struct SpiralTables {
    explicit SpiralTables(int samples);

    std::array<glm::vec4, maximum_spiral_samples / 2> tap_directions{};  // (i / N) tau turns; two unit vectors in each
    std::array<glm::vec4, spiral_spin_count / 2> spin_directions{};      // k / 1024 turns; two unit vectors in each
};
static_assert(sizeof(SpiralTables) <= 16384);

// The tables on the GPU.
class SampleSpiral {
public:
    SampleSpiral(GlContext& context, int samples);
    void bind() const { tables_.bind(GL_UNIFORM_BUFFER, binding); }

    // What sample_spiral.glsl needs to be compiled.
    static ShaderDefines defines(int samples, TapPattern pattern, bool varies_in_time = false);

private:
    static constexpr GLuint binding = 1;  // the view's uniforms have 0
    GlBuffer tables_;
};

}  // namespace plumb
