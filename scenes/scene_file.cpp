#include "scenes/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "embedded/wrappers.h"
#include "scenes/builtin.h"
#include "scenes/import.h"
#include "scenes/mesh_maker.h"
#include "scenes/scene_error.h"
#include "scenes/scene_file_tables.h"
#include "scenes/texture_file.h"
#include "scenes/toml_reader.h"
#include "scenes/validate.h"

namespace plumb {
namespace {

constexpr std::array wrapper_names = {"bathroom",
                                      "bathroom-glossy",
                                      "bunny",
                                      "clutter-lamps",
                                      "clutter-moving",
                                      "clutter-moving-lamp",
                                      "clutter-polished",
                                      "colonnade-lamps",
                                      "colonnade-polished",
                                      "conference",
                                      "cornell-glossy",
                                      "cornell-mirror",
                                      "cornell-moving-lamp",
                                      "cornell-original",
                                      "cornell-sphere",
                                      "crytek-sponza",
                                      "crytek-sponza-lamps",
                                      "dabrovic-sponza",
                                      "dragon",
                                      "dragon-full",
                                      "flight-helmet",
                                      "nvpro-cornell",
                                      "veach-ajar"};

using Folders = std::vector<std::filesystem::path>;

std::filesystem::path find_file(const std::string& wanted, const std::string& wanted_by, const Folders& folders) {
    if (std::filesystem::path(wanted).is_absolute() && std::filesystem::is_regular_file(wanted)) return wanted;
    std::vector<std::string> looked_in;
    for (const std::filesystem::path& folder : folders) {
        if (std::filesystem::is_regular_file(folder / wanted)) return folder / wanted;
        looked_in.push_back(folder.empty() ? "." : folder.string());
    }
    throw MissingSceneFile(wanted_by, wanted, looked_in);
}

ImportOptions read_import_options(TomlReader reader) {
    ImportOptions options;
    reader.read("scale", options.scale);
    std::string normals = "file";
    reader.read("normals", normals);
    if (normals == "face") {
        options.normals = NormalSource::face;
    } else if (normals == "smooth") {
        options.normals = NormalSource::smooth;
    } else if (normals != "file") {
        reader.complain("normals", fmt::format("has normals = '{}'; it must be 'file', 'face' or 'smooth'", normals));
    }
    float crease = glm::degrees(options.crease_angle);
    if (reader.read("crease_angle", crease)) options.crease_angle = glm::radians(crease);
    reader.read("drop_materials", options.drop_materials);
    reader.read("upside_down_textures", options.upside_down_textures);
    reader.read("flip_winding", options.flip_winding);
    reader.read("ignore_diffuse_colour_under_texture", options.ignore_diffuse_colour_under_texture);
    reader.read("specular", options.specular);
    reader.finish();
    return options;
}

void add_ground(TomlReader reader, Scene& scene) {
    Material material;
    material.name = "ground";
    material.base_colour = glm::vec3(0.5f);
    float height = 0.0f, size = 10.0f;
    glm::vec3 centre(0.0f);
    reader.read("height", height);
    reader.read("centre", centre);
    reader.read("size", size);
    reader.read("base_colour", material.base_colour);
    if (!(size > 0.0f)) reader.complain("size", "needs a positive size");
    reader.finish();
    Mesh mesh = make_mesh("ground", static_cast<int>(scene.materials.size()));
    append_quad(mesh, {centre.x - 0.5f * size, height, centre.z + 0.5f * size}, {size, 0, 0}, {0, 0, -size});
    scene.materials.push_back(material);
    add_object(scene, std::move(mesh));
}

void read_environment(TomlReader reader, Scene& scene, const std::string& wanted_by, const Folders& folders) {
    std::string image;
    if (reader.read("image", image)) {
        Texture texture = load_texture(find_file(image, wanted_by, folders), TextureContent::colour);
        texture.wrap_u = TextureWrap::repeat;
        texture.wrap_v = TextureWrap::clamp;
        scene.environment.texture = static_cast<int>(scene.textures.size());
        scene.environment.radiance = glm::vec3(1.0f);
        scene.textures.push_back(std::move(texture));
    }
    reader.read("radiance", scene.environment.radiance);
    float rotation = 0.0f;
    if (reader.read("rotation", rotation)) scene.environment.rotation = glm::radians(rotation);
    reader.finish();
}

// Makes a scene usable that says nothing of views or lights.
void complete(Scene& scene) {
    if (scene.cameras.empty()) {
        const Bounds bounds = scene.bounds();
        const float size = bounds.diagonal();
        const glm::vec3 eye = bounds.centre() + size * glm::vec3(0.45f, 0.35f, 0.85f);
        Camera camera = Camera::look_at("overview", eye, bounds.centre(), glm::radians(50.0f));
        camera.near_plane = 0.05f * size;
        camera.far_plane = 3.0f * size;
        scene.cameras.push_back(camera);
        scene.import_notes.push_back("no view given: 'overview' looks at the whole from outside");
    }
    const bool dark = scene.point_lights.empty() && scene.spot_lights.empty() && scene.directional_lights.empty() &&
                      scene.environment.is_black() && !scene.has_emissive_surfaces();
    if (dark) {
        scene.environment.radiance = glm::vec3(1.0f);
        scene.import_notes.push_back("no light given: a constant environment of radiance 1 lights it");
    }
}

std::string read_text(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    if (!input) throw SceneError(fmt::format("scene file '{}' cannot be read; check its permissions", file.string()));
    return {std::istreambuf_iterator<char>(input), {}};
}

Scene load_file(const std::filesystem::path& file, const Folders& scenes_dirs) {
    if (file.extension() == ".toml") return load_scene_text(read_text(file), file, scenes_dirs);
    Scene scene = import_scene_file(file);
    complete(scene);
    return scene;
}

}  // namespace

std::vector<std::string> wrapper_scene_names() { return {wrapper_names.begin(), wrapper_names.end()}; }

std::vector<std::filesystem::path> scenes_dirs_of_environment() {
    std::vector<std::filesystem::path> folders;
    const char* value = std::getenv("PLUMBLINE_SCENES");
    std::istringstream list(value ? value : "");
    for (std::string folder; std::getline(list, folder, ':');) {
        if (!folder.empty()) folders.emplace_back(folder);
    }
    return folders;
}

Scene load_scene_text(std::string_view text, const std::filesystem::path& file, const Folders& scenes_dirs) {
    const toml::table table = parse_toml(text, file.string());
    TomlReader reader(table, file.string(), "the scene file");
    Folders folders = {file.parent_path()};
    folders.insert(folders.end(), scenes_dirs.begin(), scenes_dirs.end());

    ImportOptions options = read_import_options(reader.table("import"));
    options.keep_apart = moving_instances(reader);
    std::string mesh, builtin;
    const bool has_mesh = reader.read("mesh", mesh), has_builtin = reader.read("builtin", builtin);
    if (has_mesh == has_builtin) reader.complain("mesh", "needs either mesh = \"FILE\" or builtin = \"NAME\"");
    Scene scene =
        has_mesh ? import_scene_file(find_file(mesh, file.string(), folders), options) : make_builtin_scene(builtin);
    scene.name = file.stem().string();
    reader.read("name", scene.name);
    reader.read("description", scene.description);
    read_materials(reader, scene);
    if (reader.has("ground")) add_ground(reader.table("ground"), scene);
    read_environment(reader.table("environment"), scene, file.string(), folders);
    read_lights(reader, scene);
    read_views(reader, scene);
    read_paths(reader, scene);
    read_motions(reader, scene);
    reader.finish();
    complete(scene);
    validate(scene);
    return scene;
}

Scene load_scene(const std::string& name_or_path, const Folders& scenes_dirs) {
    const std::vector<std::string> builtins = builtin_scene_names();
    if (std::ranges::find(builtins, name_or_path) != builtins.end()) {
        return make_builtin_scene(name_or_path);
    }
    if (std::ranges::find(wrapper_names, name_or_path) != wrapper_names.end()) {
        const std::string file = name_or_path + ".toml";
        return load_scene_text(embedded::wrappers::find(file), file, scenes_dirs);
    }
    if (std::filesystem::is_regular_file(name_or_path)) return load_file(name_or_path, scenes_dirs);
    for (const std::filesystem::path& folder : scenes_dirs) {
        if (std::filesystem::is_regular_file(folder / name_or_path))
            return load_file(folder / name_or_path, scenes_dirs);
    }
    std::vector<std::string> names = builtins;
    names.insert(names.end(), wrapper_names.begin(), wrapper_names.end());
    const std::string nearest = nearest_word(name_or_path, names);
    throw SceneError(fmt::format("no scene '{}'{}. Give a file (.toml, .gltf, .obj, .ply...) or one of: {}",
                                 name_or_path, nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest),
                                 fmt::join(names, ", ")));
}

}  // namespace plumb
