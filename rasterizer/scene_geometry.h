// The scene on the GPU: one vertex and one index buffer for all meshes, textures, and one uniform block per instance.
//
// Meshes without normals get unshared vertices with their exact face normals. Textures keep their half floats and only
// level 0, read bilinearly, as Texture::sample does on the CPU.
#pragma once

#include <vector>

#include "rasterizer/frustum.h"
#include "rasterizer/moment.h"
#include "rasterizer/shader.h"
#include "scenes/scene.h"

namespace plumb {

// Which of its material's parts a surface needs a shader to evaluate; shaders are compiled for the combinations that
// the scene holds.
struct MaterialVariant {
    bool base_colour_texture = false;
    bool metallic_roughness_texture = false;
    bool emission = false;
    bool emission_texture = false;
    bool alpha_mask = false;     // from any texture
    bool alpha_texture = false;  // from a texture of its own

    bool operator==(const MaterialVariant&) const = default;
    bool needs_texture_coordinates() const {
        return base_colour_texture || metallic_roughness_texture || emission_texture || alpha_mask;
    }
    // The switches of material.glsl and scene.vert.
    ShaderDefines defines() const;
    // What decides where the surface exists, and nothing else: for depth-only passes.
    MaterialVariant coverage() const;
};
MaterialVariant variant_of(const Material& material);

// One instance, ready to draw.
struct SceneDraw {
    int instance = 0;
    int material = 0;
    int variant = 0;        // index into SceneGeometry::variants()
    bool mirrored = false;  // its transform turns counter-clockwise triangles clockwise
    GLsizei index_count = 0;
    std::size_t first_index = 0;
    GLint first_vertex = 0;
    Bounds bounds;       // world space
    Bounds next_bounds;  // in the frame to come
};

class SceneGeometry {
public:
    SceneGeometry(GlContext& context, const Scene& scene);

    const std::vector<MaterialVariant>& variants() const { return variants_; }
    const std::vector<SceneDraw>& draws() const { return draws_; }  // by variant, then by material

    // Puts the instances that move where they are at each moment. Without `next` they are taken to go on as they moved
    // since `previous`.
    void move_to(const Moment& now, const Moment& previous, const Moment* next);
    bool anything_moves() const { return !moving_.empty(); }

    void bind() const { vertex_array_.bind(); }
    // Binds the textures that `variant` reads to units 0 to 3 (material.glsl).
    void bind_textures(const Material& material, const MaterialVariant& variant) const;
    // Draws with the current program; bind() comes first.
    void draw(const SceneDraw& draw, int copies = 1) const;
    // As patches of three vertices, `most_patches` at a time.
    void draw_patches(const SceneDraw& draw, int most_patches) const;

    static constexpr GLuint first_free_texture_unit = 4;

private:
    struct Poses {
        glm::mat4 now{1.0f}, next{1.0f};
        bool operator==(const Poses&) const = default;
    };
    struct MovingDraw {
        std::size_t draw;  // index into draws_
        Bounds object_bounds;
        Poses poses;  // as uploaded
    };

    void upload_meshes();
    void upload_instances();
    void upload_textures();
    void bind_instance(const SceneDraw& draw) const;
    void find_moving();

    GlContext& context_;
    const Scene& scene_;
    std::vector<SceneDraw> draws_;
    std::vector<MaterialVariant> variants_;
    GlBuffer vertices_, indices_, instances_;
    std::size_t instance_stride_ = 0;
    std::vector<int> moving_numbers_;  // of every instance
    std::vector<MovingDraw> moving_;
    GlVertexArray vertex_array_;
    std::vector<GlTexture> textures_;
};

}  // namespace plumb
