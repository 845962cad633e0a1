#include "scenes/import_materials.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/gltf_extras.h"
#include "scenes/scene_error.h"
#include "scenes/texture_file.h"

namespace plumb {
namespace {

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string percent_decoded(const std::string& text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool code = text[i] == '%' && i + 2 < text.size() &&
                          std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
                          std::isxdigit(static_cast<unsigned char>(text[i + 2]));
        decoded += code ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
        if (code) i += 2;
    }
    return decoded;
}

// `wanted` beside `folder`: as written, percent-decoded, or with other letter case (files that were written on
// Windows).
std::optional<std::filesystem::path> find_texture(const std::filesystem::path& folder, std::string wanted) {
    std::ranges::replace(wanted, '\\', '/');
    for (const std::string& name : {wanted, percent_decoded(wanted)}) {
        if (std::filesystem::is_regular_file(folder / name)) return folder / name;
    }
    std::filesystem::path place = folder;
    for (const std::filesystem::path& part : std::filesystem::path(wanted)) {
        std::error_code error;
        std::filesystem::path match = place / part;
        if (!std::filesystem::exists(match, error)) {
            for (const auto& entry : std::filesystem::directory_iterator(place, error)) {
                if (lower_case(entry.path().filename()) == lower_case(part)) match = entry.path();
            }
        }
        place = match;
    }
    if (std::filesystem::is_regular_file(place)) return place;
    return std::nullopt;
}

TextureWrap wrap_of(int mode) {
    switch (mode) {
        case aiTextureMapMode_Clamp:
        case aiTextureMapMode_Decal:
            return TextureWrap::clamp;
        case aiTextureMapMode_Mirror:
            return TextureWrap::mirror;
        default:
            return TextureWrap::repeat;
    }
}

struct ChannelRange {
    float lowest = 1.0f, mean = 0.0f;
};

ChannelRange range_of(const Texture& texture, int channel) {
    ChannelRange range;
    double sum = 0.0;
    for (std::size_t i = static_cast<std::size_t>(channel); i < texture.value_count(); i += 4) {
        const float value = texture.value(i);
        range.lowest = std::min(range.lowest, value);
        sum += value;
    }
    range.mean = static_cast<float>(sum / (0.25 * static_cast<double>(texture.value_count())));
    return range;
}

constexpr float hole_alpha = 0.1f;           // an image of alpha that falls below it has holes
constexpr float largest_exponent = 1000.0f;  // of Ns, which MTL limits to 0..1000

float luminance(const glm::vec3& colour) { return glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

// A sheet that covers a share `coverage` of what lies behind; `tint` is what the rest passes. Returns false where
// nothing of the sheet is left.
bool cover(Material& material, float coverage, const glm::vec3& tint) {
    if (coverage > 1.0f - 0.5f / 255.0f) return true;  // opaque but for the rounding to 8 bits
    material.transmission = coverage * material.transmission + (1.0f - coverage) * tint;
    material.base_colour *= coverage;
    material.emission *= coverage;
    return coverage > 0.0f;
}

class MaterialImporter {
public:
    MaterialImporter(const aiScene& source, const std::filesystem::path& file, const GltfExtras* extras,
                     const ImportOptions& options, Scene& scene)
        : source_(source), file_(file), extras_(extras), options_(options), scene_(scene) {}

    std::vector<bool> run() {
        std::vector<std::string> invisible, transparent;
        for (unsigned i = 0; i < source_.mNumMaterials; ++i) {
            const aiMaterial& from = *source_.mMaterials[i];
            Material material;
            material.name = from.GetName().C_Str();
            const bool left_out = extras_ ? read_gltf(from, i, material) : read_classic(from, material);
            if (left_out)
                invisible.push_back(material.name);
            else if (material.is_transparent())
                transparent.push_back(material.name);
            left_out_.push_back(left_out);
            scene_.materials.push_back(std::move(material));
        }
        if (!invisible.empty()) note("invisible materials left out: {}", fmt::join(invisible, ", "));
        if (!transparent.empty()) {
            note("transparent materials, taken as thin sheets without refraction: {}", fmt::join(transparent, ", "));
        }
        drop_by_name();
        for (const std::string& name : options_.upside_down_textures) {
            if (!flipped_.contains(name)) {
                throw SceneError(
                    fmt::format("'{}' uses no texture '{}' that could be upside down", file_.string(), name));
            }
        }
        return left_out_;
    }

private:
    template <typename... Arguments>
    void note(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
        scene_.import_notes.push_back(
            fmt::format("{}: {}", file_.filename().string(), fmt::format(text, std::forward<Arguments>(arguments)...)));
    }

    void drop_by_name() {
        for (const std::string& name : options_.drop_materials) {
            bool found = false;
            for (std::size_t i = 0; i < left_out_.size(); ++i) {
                if (scene_.materials[i].name == name) left_out_[i] = found = true;
            }
            if (found) continue;
            std::vector<std::string> names;
            for (const Material& material : scene_.materials) names.push_back(material.name);
            throw SceneError(fmt::format("'{}' has no material '{}' to drop; it has: {}", file_.string(), name,
                                         fmt::join(names, ", ")));
        }
    }

    void limit_colour(Material& material) {
        const glm::vec3 limited = glm::clamp(material.base_colour, 0.0f, 1.0f);
        if (limited == material.base_colour) return;
        note("material '{}': base colour ({}, {}, {}) limited to 0..1", material.name, material.base_colour.x,
             material.base_colour.y, material.base_colour.z);
        material.base_colour = limited;
    }

    // Index of the texture in slot (`type`, 0), loaded once; no_texture where the slot is empty.
    int texture(const aiMaterial& from, aiTextureType type, TextureContent content, const std::string& material) {
        aiString path;
        aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        unsigned uv_set = 0;
        if (from.GetTexture(type, 0, &path, nullptr, &uv_set, nullptr, nullptr, modes) != aiReturn_SUCCESS)
            return no_texture;
        if (uv_set != 0)
            note("material '{}': texture '{}' uses UV set {}; set 0 is used", material, path.C_Str(), uv_set);
        const TextureWrap wrap_u = wrap_of(modes[0]), wrap_v = wrap_of(modes[1]);
        const auto key = std::tuple(std::string(path.C_Str()), content, wrap_u, wrap_v);
        if (const auto known = textures_.find(key); known != textures_.end()) return known->second;
        Texture loaded = read_texture(path.C_Str(), content, material);
        if (is_upside_down(path.C_Str())) flip_rows(loaded);
        loaded.wrap_u = wrap_u;
        loaded.wrap_v = wrap_v;
        scene_.textures.push_back(std::move(loaded));
        return textures_[key] = static_cast<int>(scene_.textures.size()) - 1;
    }

    bool is_upside_down(std::string path) {
        std::ranges::replace(path, '\\', '/');
        const std::string name = std::filesystem::path(path).filename();
        if (std::ranges::find(options_.upside_down_textures, name) == options_.upside_down_textures.end()) return false;
        flipped_.insert(name);
        return true;
    }

    Texture read_texture(const std::string& path, TextureContent content, const std::string& material) {
        try {
            if (const aiTexture* embedded = source_.GetEmbeddedTexture(path.c_str()))
                return decode(*embedded, path, content);
            const auto file = find_texture(file_.parent_path(), path);
            if (file) return load_texture(*file, content);
            note(
                "material '{}': texture '{}' not found beside the file; a magenta checker stands in. Put the image "
                "there or correct the path",
                material, path);
        } catch (const SceneError& error) {
            note("material '{}': {}; a magenta checker stands in", material, error.what());
        }
        return missing_texture(path);
    }

    static Texture decode(const aiTexture& embedded, const std::string& path, TextureContent content) {
        if (embedded.mHeight != 0) throw SceneError(fmt::format("embedded texture '{}' holds raw texels", path));
        const std::string name = fmt::format("embedded{}.{}", path, embedded.achFormatHint);
        return decode_texture(std::as_bytes(std::span(reinterpret_cast<const char*>(embedded.pcData), embedded.mWidth)),
                              name, content);
    }

    static glm::vec3 colour(const aiMaterial& from, const char* key, unsigned type, unsigned index,
                            const glm::vec3& otherwise) {
        aiColor3D value;
        return from.Get(key, type, index, value) == aiReturn_SUCCESS ? glm::vec3(value.r, value.g, value.b) : otherwise;
    }
    static float number(const aiMaterial& from, const char* key, unsigned type, unsigned index, float otherwise) {
        float value = otherwise;
        from.Get(key, type, index, value);
        return value;
    }

    // True where the material is to be left out.
    bool read_gltf(const aiMaterial& from, unsigned index, Material& material) {
        material.base_colour = colour(from, AI_MATKEY_BASE_COLOR, glm::vec3(1.0f));
        material.base_colour_texture = texture(from, aiTextureType_BASE_COLOR, TextureContent::colour, material.name);
        material.metallic = number(from, AI_MATKEY_METALLIC_FACTOR, 1.0f);
        material.roughness = number(from, AI_MATKEY_ROUGHNESS_FACTOR, 1.0f);
        material.metallic_roughness_texture =
            texture(from, aiTextureType_METALNESS, TextureContent::data, material.name);
        const GltfMaterial extra = index < extras_->materials.size() ? extras_->materials[index] : GltfMaterial{};
        material.dielectric_reflectance = extra.dielectric_reflectance;
        material.emission = extra.emissive_strength * colour(from, AI_MATKEY_COLOR_EMISSIVE, glm::vec3(0.0f));
        material.emission_texture = texture(from, aiTextureType_EMISSIVE, TextureContent::colour, material.name);
        bool double_sided = false;
        from.Get(AI_MATKEY_TWOSIDED, double_sided);
        material.two_sided = double_sided;

        limit_colour(material);
        if (extra.transmission > 0.0f) {
            float metallic = material.metallic;
            if (material.metallic_roughness_texture != no_texture) {
                metallic *= range_of(scene_.textures[material.metallic_roughness_texture], 2).mean;
            }
            const float through = extra.transmission * (1.0f - metallic);
            material.transmission = through * material.base_colour;
            material.base_colour *= 1.0f - through;
        }
        return !read_gltf_alpha(from, material);
    }

    // False where the material is invisible.
    bool read_gltf_alpha(const aiMaterial& from, Material& material) {
        aiString mode("OPAQUE");
        from.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
        if (mode == aiString("OPAQUE")) return true;
        aiColor4D factor(1.0f, 1.0f, 1.0f, 1.0f);
        from.Get(AI_MATKEY_BASE_COLOR, factor);
        const bool has_texture = material.base_colour_texture != no_texture;
        if (mode == aiString("MASK")) {
            const float cutoff = number(from, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f);
            if (factor.a < cutoff) return false;
            material.alpha_mask = has_texture;
            material.alpha_cutoff = has_texture ? cutoff / factor.a : material.alpha_cutoff;
            return true;
        }
        ChannelRange alpha{1.0f, 1.0f};
        if (has_texture) alpha = range_of(scene_.textures[material.base_colour_texture], 3);
        material.alpha_mask = alpha.lowest < hole_alpha;
        if (material.alpha_mask) {
            note("material '{}': alphaMode BLEND with an image of alpha that has holes taken as a mask at alpha 0.5",
                 material.name);
        }
        return cover(material, factor.a * (material.alpha_mask ? 1.0f : alpha.mean), glm::vec3(1.0f));
    }

    bool read_classic(const aiMaterial& from, Material& material) {
        material.base_colour = colour(from, AI_MATKEY_COLOR_DIFFUSE, glm::vec3(0.6f));
        material.base_colour_texture = texture(from, aiTextureType_DIFFUSE, TextureContent::colour, material.name);
        if (options_.ignore_diffuse_colour_under_texture && material.base_colour_texture != no_texture) {
            material.base_colour = glm::vec3(1.0f);
        }
        limit_colour(material);
        const float coverage = number(from, AI_MATKEY_OPACITY, 1.0f);
        read_highlight(from, coverage < 1.0f, material);
        material.emission = colour(from, AI_MATKEY_COLOR_EMISSIVE, glm::vec3(0.0f));
        material.emission_texture = texture(from, aiTextureType_EMISSIVE, TextureContent::colour, material.name);
        if (material.emission_texture != no_texture && !material.is_emissive()) material.emission = glm::vec3(1.0f);

        material.alpha_texture = texture(from, aiTextureType_OPACITY, TextureContent::data, material.name);
        if (material.alpha_texture != no_texture) {
            const Texture& mask = scene_.textures[material.alpha_texture];
            material.alpha_mask = true;
            material.alpha_channel =
                range_of(mask, 3).lowest < 1.0f ? 3 : 0;  // a mask image is grey, or carries it in its alpha
        }
        // Other formats than MTL give this colour other meanings.
        const bool is_mtl = lower_case(file_.extension()) == ".obj";
        const glm::vec3 filter = is_mtl ? colour(from, AI_MATKEY_COLOR_TRANSPARENT, glm::vec3(1.0f)) : glm::vec3(1.0f);
        return !cover(material, coverage, glm::clamp(filter, 0.0f, 1.0f));
    }

    void read_highlight(const aiMaterial& from, bool transparent, Material& material) {
        const glm::vec3 specular = colour(from, AI_MATKEY_COLOR_SPECULAR, glm::vec3(0.0f));
        const float brightest = std::max({specular.x, specular.y, specular.z});
        const float exponent = number(from, AI_MATKEY_SHININESS, 0.0f);
        if (brightest > 0.0f && exponent > 0.0f) {
            // Blinn-Phong exponent to GGX alpha: alpha = sqrt(2 / (n + 2)) (Walter et al. 2007); roughness =
            // sqrt(alpha).
            material.roughness = std::pow(2.0f / (exponent + 2.0f), 0.25f);
        }
        if (!transparent && material.base_colour == glm::vec3(0.0f) && brightest > 0.1f) {
            material.base_colour = specular;
            material.metallic = 1.0f;
        }
        int illumination = 2;  // MTL's models: 0 without any, 3 and more with traced reflections
        from.Get(AI_MATKEY_OBJ_ILLUM, illumination);
        if (!options_.specular || brightest == 0.0f || illumination == 0) return;
        if (illumination > 2 || exponent >= largest_exponent) material.roughness = 0.0f;
        const bool mirror = illumination == 3 || illumination == 5 || illumination == 8;
        const float index = number(from, AI_MATKEY_REFRACTI, 1.0f);
        if (mirror && luminance(specular) > luminance(material.base_colour)) {
            material.base_colour = specular;
            material.metallic = 1.0f;
        } else if (material.metallic == 0.0f) {
            const float root = (index - 1.0f) / (index + 1.0f);
            const float reflectance = transparent && index > 1.0f ? root * root : luminance(specular);
            material.dielectric_reflectance = std::min(reflectance, 1.0f);
        }
        limit_colour(material);
    }

    const aiScene& source_;
    const std::filesystem::path& file_;
    const GltfExtras* extras_;
    const ImportOptions& options_;
    Scene& scene_;
    std::vector<bool> left_out_;
    std::set<std::string> flipped_;
    std::map<std::tuple<std::string, TextureContent, TextureWrap, TextureWrap>, int> textures_;
};

}  // namespace

std::vector<bool> import_materials(const aiScene& source, const std::filesystem::path& file, const GltfExtras* extras,
                                   const ImportOptions& options, Scene& scene) {
    return MaterialImporter(source, file, extras, options, scene).run();
}

}  // namespace plumb
