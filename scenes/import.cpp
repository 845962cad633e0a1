#include "scenes/import.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "scenes/gltf_extras.h"
#include "scenes/import_materials.h"
#include "scenes/obj_references.h"
#include "scenes/repair.h"
#include "scenes/scene_error.h"
#include "scenes/smooth_normals.h"
#include "scenes/validate.h"
#include "scenes/weld.h"

namespace plumb {
namespace {

std::string extension_of(const std::filesystem::path& file) {
    std::string extension = file.extension();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

glm::vec3 to_glm(const aiVector3D& v) { return {v.x, v.y, v.z}; }
glm::vec3 to_glm(const aiColor3D& c) { return {c.r, c.g, c.b}; }
glm::mat4 to_glm(const aiMatrix4x4& m) {  // Assimp's are row-major
    return {{m.a1, m.b1, m.c1, m.d1}, {m.a2, m.b2, m.c2, m.d2}, {m.a3, m.b3, m.c3, m.d3}, {m.a4, m.b4, m.c4, m.d4}};
}

class FileImporter {
public:
    FileImporter(const std::filesystem::path& file, const ImportOptions& options)
        : file_(file), options_(options), extension_(extension_of(file)) {}

    Scene run() {
        if (!(options_.scale > 0.0f && std::isfinite(options_.scale))) {
            throw SceneError(fmt::format("'{}': scale {} must be positive", file_.string(), options_.scale));
        }
        if (!std::filesystem::is_regular_file(file_)) {
            throw SceneError(fmt::format("mesh '{}' not found; check the path", file_.string()));
        }
        scene_.name = file_.stem().string();
        if (extension_ == ".gltf" || extension_ == ".glb") extras_ = read_gltf_extras(file_);
        read();
        left_out_ = import_materials(*source_, file_, extras_ ? &*extras_ : nullptr, options_, scene_);
        for (unsigned i = 0; i < source_->mNumMeshes; ++i) convert_mesh(*source_->mMeshes[i]);
        add_instances(*source_->mRootNode, glm::mat4(1.0f));
        bake_mirrored_instances();
        join_meshes();
        drop_unused_meshes();
        if (scene_.instances.empty()) {
            throw SceneError(fmt::format("'{}' holds no triangle that can be drawn ({}); check the file",
                                         file_.string(), counts_.summary()));
        }
        if (extras_) {
            import_cameras();
            import_lights();
        }
        add_notes();
        validate(scene_);
        return std::move(scene_);
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        const std::string fault = extension_ == ".obj" ? first_obj_fault(file_) : "";
        throw SceneError(fmt::format("'{}' cannot be imported: {}{}; correct that line or export the file again",
                                     file_.string(), fault.empty() ? "" : fault + ": ", reason));
    }

    // Reads without any processing first, since Assimp's steps trust indices and coordinates.
    void read() {
        importer_.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        source_ = importer_.ReadFile(file_.string(), 0);
        if (!source_) fail(importer_.GetErrorString());
        for (unsigned i = 0; i < source_->mNumMeshes; ++i) check(*source_->mMeshes[i]);
        if (source_->mNumMeshes == 0 || triangles_and_polygons_ == 0) fail("it holds no faces");
        if (source_ = importer_.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType); !source_) {
            fail("its polygons cannot be cut into triangles");
        }
    }

    void check(const aiMesh& mesh) {
        std::vector<bool> used(mesh.mNumVertices);
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            (face.mNumIndices < 3 ? lines_and_points_ : triangles_and_polygons_) += 1;
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                if (face.mIndices[i] >= mesh.mNumVertices) {
                    fail(fmt::format("mesh '{}', face {}: vertex index {} is out of range (the mesh has {} vertices)",
                                     mesh.mName.C_Str(), f, face.mIndices[i], mesh.mNumVertices));
                }
                used[face.mIndices[i]] = true;
            }
        }
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            if (used[v] && !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) {
                fail(fmt::format("mesh '{}': vertex {} is ({}, {}, {}), not a finite point", mesh.mName.C_Str(), v, p.x,
                                 p.y, p.z));
            }
        }
        has_vertex_colours_ = has_vertex_colours_ || mesh.HasVertexColors(0);
    }

    void convert_mesh(const aiMesh& from) {
        Mesh mesh;
        mesh.name = from.mName.C_Str();
        mesh.material = static_cast<int>(from.mMaterialIndex);
        if (left_out_[from.mMaterialIndex]) {
            left_out_triangles_ += from.mNumFaces;
        } else {
            for (unsigned i = 0; i < from.mNumVertices; ++i) {
                mesh.positions.push_back(options_.scale * to_glm(from.mVertices[i]));
                if (from.HasNormals() && options_.normals == NormalSource::file) {
                    mesh.normals.push_back(to_glm(from.mNormals[i]));
                }
                // Assimp's v points upwards, whatever the file's does.
                const aiVector3D* uvs = from.mTextureCoords[0];
                if (uvs) mesh.uvs.push_back({uvs[i].x, 1.0f - uvs[i].y});
            }
            for (unsigned f = 0; f < from.mNumFaces; ++f) {
                const unsigned* index = from.mFaces[f].mIndices;
                mesh.triangles.push_back({index[0], index[1], index[2]});
            }
            prepare(mesh);
        }
        scene_.meshes.push_back(std::move(mesh));
    }

    void prepare(Mesh& mesh) {
        const Material& material = scene_.materials[mesh.material];
        if (material.base_colour_texture == no_texture && material.metallic_roughness_texture == no_texture &&
            material.emission_texture == no_texture && material.alpha_texture == no_texture) {
            mesh.uvs.clear();  // nothing reads them
        }
        if (options_.flip_winding) {
            for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
            for (glm::vec3& normal : mesh.normals) normal = -normal;
        }
        counts_ += repair(mesh, file_.string(), material.two_sided);
        if (options_.normals == NormalSource::smooth) {
            make_smooth_normals(mesh, options_.crease_angle);
            counts_ += repair(mesh, file_.string(), material.two_sided);
        } else {
            weld(mesh);
        }
    }

    void add_instances(const aiNode& node, const glm::mat4& parent) {
        const glm::mat4 world = parent * to_glm(node.mTransformation);
        glm::mat4 scaled = world;
        scaled[3] = glm::vec4(options_.scale * glm::vec3(world[3]), world[3].w);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            const int mesh = static_cast<int>(node.mMeshes[i]);
            if (scene_.meshes[mesh].triangles.empty()) continue;
            if (glm::determinant(glm::mat3(scaled)) == 0.0f) {
                note("node '{}' flattens its mesh '{}'; left out", node.mName.C_Str(), scene_.meshes[mesh].name);
                continue;
            }
            scene_.instances.push_back({node.mName.C_Str(), mesh, scaled});
        }
        world_of_node_.emplace(node.mName.C_Str(), scaled);
        for (unsigned i = 0; i < node.mNumChildren; ++i) add_instances(*node.mChildren[i], world);
    }

    // A mirroring transform turns front into back. Such instances get a mesh of their own with the transform applied.
    void bake_mirrored_instances() {
        for (Instance& instance : scene_.instances) {
            const glm::mat3 linear(instance.world_from_object);
            if (glm::determinant(linear) > 0.0f) continue;
            Mesh mesh = scene_.meshes[instance.mesh];
            for (glm::vec3& p : mesh.positions) p = glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f));
            const glm::mat3 normal_matrix = glm::inverseTranspose(linear);
            for (glm::vec3& n : mesh.normals) n = glm::normalize(normal_matrix * n);
            for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
            instance.mesh = static_cast<int>(scene_.meshes.size());
            instance.world_from_object = glm::mat4(1.0f);
            scene_.meshes.push_back(std::move(mesh));
            ++mirrored_;
        }
    }

    // Meshes of one material that are drawn once and where they are become one: fewer draws, one tree to trace.
    void join_meshes() {
        std::vector<int> uses(scene_.meshes.size());
        for (const Instance& instance : scene_.instances) ++uses[instance.mesh];
        std::map<std::tuple<int, bool, bool>, std::vector<const Mesh*>> groups;
        std::vector<Instance> instances;
        for (const Instance& instance : scene_.instances) {
            const Mesh& mesh = scene_.meshes[instance.mesh];
            const bool apart = std::ranges::find(options_.keep_apart, instance.name) != options_.keep_apart.end();
            if (!apart && uses[instance.mesh] == 1 && instance.world_from_object == glm::mat4(1.0f)) {
                groups[{mesh.material, mesh.normals.empty(), mesh.uvs.empty()}].push_back(&mesh);
            } else {
                instances.push_back(instance);
            }
        }
        std::vector<Mesh> joined;
        for (const auto& [key, group] : groups) {
            joined.push_back(join(group));
            if (group.size() == 1) continue;
            joined.back().name = scene_.materials[joined.back().material].name;
            counts_ += repair(joined.back(), file_.string(), scene_.materials[joined.back().material].two_sided);
        }
        for (Mesh& mesh : joined) {
            instances.push_back({mesh.name, static_cast<int>(scene_.meshes.size()), glm::mat4(1.0f)});
            scene_.meshes.push_back(std::move(mesh));
        }
        scene_.instances = std::move(instances);
    }

    void drop_unused_meshes() {
        std::vector<int> new_index(scene_.meshes.size(), -1);
        std::vector<Mesh> kept;
        for (Instance& instance : scene_.instances) {
            int& index = new_index[instance.mesh];
            if (index < 0) {
                index = static_cast<int>(kept.size());
                kept.push_back(std::move(scene_.meshes[instance.mesh]));
            }
            instance.mesh = index;
        }
        scene_.meshes = std::move(kept);
    }

    glm::mat4 world_of(const aiString& node) const {
        const auto found = world_of_node_.find(node.C_Str());
        return found == world_of_node_.end() ? glm::mat4(1.0f) : found->second;
    }

    void import_cameras() {
        for (unsigned i = 0; i < source_->mNumCameras; ++i) {
            const aiCamera& from = *source_->mCameras[i];
            const auto fov = i < extras_->vertical_fovs.size() ? extras_->vertical_fovs[i] : std::nullopt;
            if (!fov) {
                note("camera '{}' is not a perspective one; left out", from.mName.C_Str());
                continue;
            }
            const glm::mat4 world = world_of(from.mName);
            const glm::vec3 eye(world[3]);
            Camera camera =
                Camera::look_at(from.mName.C_Str(), eye, eye - glm::vec3(world[2]), *fov, glm::vec3(world[1]));
            camera.near_plane = options_.scale * from.mClipPlaneNear;
            camera.far_plane = options_.scale * from.mClipPlaneFar;
            scene_.cameras.push_back(camera);
        }
    }

    // A length of s metres per unit makes areas s^2 larger: intensities follow, so that the picture keeps its
    // brightness.
    void import_lights() {
        for (unsigned i = 0; i < source_->mNumLights; ++i) {
            const aiLight& from = *source_->mLights[i];
            const glm::mat4 world = world_of(from.mName);
            const glm::vec3 colour = to_glm(from.mColorDiffuse);
            const glm::vec3 intensity = options_.scale * options_.scale * colour;
            const glm::vec3 direction = -glm::normalize(glm::vec3(world[2]));
            const std::string name = from.mName.C_Str();
            if (from.mType == aiLightSource_POINT) {
                scene_.point_lights.push_back({name, glm::vec3(world[3]), intensity});
            } else if (from.mType == aiLightSource_DIRECTIONAL) {
                scene_.directional_lights.push_back({name, direction, colour});
            } else if (from.mType == aiLightSource_SPOT) {
                // A half angle of 90 degrees is allowed there; a shadow map cannot hold it.
                const float outer = std::min(from.mAngleOuterCone, 0.49f * std::numbers::pi_v<float>);
                const float inner = std::min(from.mAngleInnerCone, 0.999f * outer);
                scene_.spot_lights.push_back({name, glm::vec3(world[3]), direction, intensity, inner, outer});
            } else {
                note("light '{}' is of a kind that glTF does not have; left out", name);
            }
        }
    }

    void add_notes() {
        if (extension_ == ".obj") {
            for (const std::string& missing : missing_obj_references(file_)) note("{}", missing);
        }
        std::vector<std::string> ignored;
        if (extras_ && !extras_->ignored_extensions.empty()) {
            ignored.push_back(fmt::format("extensions {}", fmt::join(extras_->ignored_extensions, ", ")));
        }
        if (extras_ && extras_->has_normal_maps) ignored.push_back("normal maps");
        if (extras_ && extras_->has_specular_maps) ignored.push_back("specular maps");
        if (extras_ && extras_->has_transmission_maps) ignored.push_back("transmission maps");
        if (has_vertex_colours_) ignored.push_back("vertex colours");
        if (!extras_ && source_->mNumCameras + source_->mNumLights > 0) {
            ignored.push_back("cameras and lights, whose units this format does not define");
        }
        if (!ignored.empty()) note("not used: {}", fmt::join(ignored, "; "));

        std::string changes = counts_.summary();
        if (lines_and_points_ > 0) changes += fmt::format(", {} lines and points dropped", lines_and_points_);
        if (left_out_triangles_ > 0) {
            changes += fmt::format(", {} triangles of materials left out", left_out_triangles_);
        }
        if (mirrored_ > 0) changes += fmt::format(", {} mirrored instances written out", mirrored_);
        scene_.import_notes.insert(
            scene_.import_notes.begin(),
            fmt::format("{}: {} triangles, {} materials{}, {} textures, {:g} m per unit; {}", file_.filename().string(),
                        scene_.triangle_count(), scene_.materials.size(), lobes_of_materials(), scene_.textures.size(),
                        options_.scale, changes));
    }

    // " (3 glossy, 1 transparent)" of those in use.
    std::string lobes_of_materials() const {
        std::set<int> used;
        for (const Mesh& mesh : scene_.meshes) used.insert(mesh.material);
        const auto count = [&](bool (Material::*property)() const) {
            return std::ranges::count_if(used, [&](int i) { return (scene_.materials[i].*property)(); });
        };
        const auto glossy = count(&Material::has_specular_lobe), transparent = count(&Material::is_transparent);
        return glossy + transparent == 0 ? "" : fmt::format(" ({} glossy, {} transparent)", glossy, transparent);
    }

    template <typename... Arguments>
    void note(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
        scene_.import_notes.push_back(
            fmt::format("{}: {}", file_.filename().string(), fmt::format(text, std::forward<Arguments>(arguments)...)));
    }

    const std::filesystem::path& file_;
    const ImportOptions& options_;
    std::string extension_;
    Scene scene_;
    Assimp::Importer importer_;
    const aiScene* source_ = nullptr;
    std::optional<GltfExtras> extras_;
    std::vector<bool> left_out_;
    std::map<std::string, glm::mat4> world_of_node_;
    RepairCounts counts_;
    std::size_t lines_and_points_ = 0, triangles_and_polygons_ = 0, mirrored_ = 0, left_out_triangles_ = 0;
    bool has_vertex_colours_ = false;
};

}  // namespace

Scene import_scene_file(const std::filesystem::path& file, const ImportOptions& options) {
    return FileImporter(file, options).run();
}

}  // namespace plumb
