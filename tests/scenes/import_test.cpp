#include "scenes/import.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scenes/scene_error.h"
#include "tests/message_of.h"
#include "tests/scenes/small_files.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

double area(const Scene& scene) {
    double sum = 0.0;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x];
            sum += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        }
    }
    return sum;
}

std::string failure(const std::filesystem::path& file, const ImportOptions& options = {}) {
    return message_of<SceneError>([&] { import_scene_file(file, options); });
}

TEST(ImportObj, ReadsNegativeIndices) {
    const TemporaryFolder folder;
    const Scene scene = import_scene_file(folder.write(
        "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 6 1 0\nf -3 -2 -1\n"));
    EXPECT_EQ(scene.triangle_count(), 3u);
    EXPECT_NEAR(area(scene), 1.5, 1e-6);
}

TEST(ImportObj, CutsAConcavePolygonIntoItsOwnArea) {
    const TemporaryFolder folder;
    // A comb of 20 teeth in a slanted plane, 82 corners; area by the shoelace formula: base 40 x 1, teeth 20 x 1 x 3.
    std::string obj = "v 0 0 0\nv 40 0 0\n", face = "f 1 2";
    int corners = 2;
    for (int i = 20; i-- > 0;) {
        for (const auto& [x, y] : {std::pair(2 * i + 2, 1), {2 * i + 1, 1}, {2 * i + 1, 4}, {2 * i, 4}}) {
            if (i == 19 && x == 40)
                obj += "v 40 1 1\n";
            else
                obj += fmt::format("v {} {} {}\n", x, y, y);
            face += fmt::format(" {}", ++corners);
        }
    }
    const Scene scene = import_scene_file(folder.write("comb.obj", obj + face + "\n"));
    EXPECT_NEAR(area(scene), std::sqrt(2.0) * 100.0, 1e-3);  // float rounding of coordinates up to 40
}

TEST(ImportObj, DropsLinesAndSaysSo) {
    const TemporaryFolder folder;
    const Scene scene = import_scene_file(folder.write("a.obj", std::string(triangle_obj) + "l 1 2\nl 2 3\n"));
    EXPECT_EQ(scene.triangle_count(), 1u);
    EXPECT_THAT(scene.import_notes.front(), HasSubstr("lines and points dropped"));
}

TEST(ImportObj, ReadsMaterialsWithBackslashesMasksAndWindowsLineEnds) {
    const TemporaryFolder folder;
    // Portable maps: 1 x 2 texels, upper red, lower blue; mask upper 255, lower 0.
    folder.write("Tex/Paint.ppm", std::string("P6\n1 2\n255\n") + std::string("\xff\0\0\0\0\xff", 6));
    folder.write("Tex/mask.pgm", std::string("P5\n1 2\n255\n") + std::string("\xff\0", 2));
    folder.write(
        "a.mtl",
        "newmtl cloth\r\nKd 0.588 0.588 0.588\r\nmap_Kd tex\\paint.ppm\r\nmap_d tex\\mask.pgm\r\nKe 2 1 0\r\n");
    const auto file = folder.write("a.obj",
                                   "mtllib a.mtl\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nvt 1 0\r\nvt 0 "
                                   "1\r\nusemtl cloth\r\nf 1/1 2/2 3/3\r\n");
    const Scene scene = import_scene_file(file);
    const Material& cloth = scene.materials[scene.meshes[0].material];
    EXPECT_EQ(cloth.name, "cloth");
    EXPECT_EQ(cloth.emission, glm::vec3(2, 1, 0));
    EXPECT_TRUE(cloth.two_sided);
    ASSERT_TRUE(cloth.alpha_mask);
    // OBJ's v points up: the vertex with vt 0 0 shows the picture's lower row, where the mask has its hole.
    EXPECT_FALSE(scene.is_opaque(cloth, scene.meshes[0].uvs[0] - glm::vec2(0, 0.25f)));
    EXPECT_TRUE(scene.is_opaque(cloth, {0.5f, 0.25f}));
    const glm::vec3 upper = scene.surface(cloth, {0.5f, 0.25f}).albedo;
    EXPECT_NEAR(upper.x, 0.588f, 1e-6f);
    EXPECT_EQ(upper.z, 0.0f);
    ImportOptions plain;
    plain.ignore_diffuse_colour_under_texture = true;
    const Scene bright = import_scene_file(file, plain);
    EXPECT_EQ(bright.surface(bright.materials[bright.meshes[0].material], {0.5f, 0.25f}).albedo.x, 1.0f);
}

TEST(ImportObj, AMissingTextureIsAMagentaCheckerAndANote) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd gone.png\n");
    const Scene scene = import_scene_file(
        folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"));
    EXPECT_THAT(scene.import_notes, Contains(AllOf(HasSubstr("'m'"), HasSubstr("gone.png"), HasSubstr("magenta"))));
    const glm::vec3 albedo = scene.surface(scene.materials[scene.meshes[0].material], {1.0f / 16, 1.0f / 16}).albedo;
    EXPECT_EQ(albedo, glm::vec3(1, 0, 1));
}

TEST(ImportObj, ABrokenTextureIsAMagentaCheckerAndANote) {
    const TemporaryFolder folder;
    folder.write("bad.png", "this is no picture");
    folder.write("a.mtl", "newmtl m\nmap_Kd bad.png\n");
    const Scene scene =
        import_scene_file(folder.write("a.obj", std::string("mtllib a.mtl\nusemtl m\n") + triangle_obj));
    EXPECT_THAT(scene.import_notes, Contains(AllOf(HasSubstr("bad.png"), HasSubstr("magenta"))));
}

TEST(ImportObj, SaysWhichMaterialLibraryIsMissing) {
    const TemporaryFolder folder;
    const Scene scene =
        import_scene_file(folder.write("a.obj", std::string("mtllib gone.mtl\nusemtl x\n") + triangle_obj));
    EXPECT_THAT(scene.import_notes, Contains(HasSubstr("gone.mtl")));
}

TEST(ImportObj, SaysWhichMaterialIsNotDefined) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl other\n");
    const Scene scene =
        import_scene_file(folder.write("a.obj", std::string("mtllib a.mtl\nusemtl x\n") + triangle_obj));
    EXPECT_THAT(scene.import_notes, Contains(HasSubstr("'x' is not defined")));
}

TEST(ImportObj, NamesTheLineOfAnIndexOutOfRange) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n");
    EXPECT_THAT(failure(file), AllOf(HasSubstr("a.obj"), HasSubstr("line 5"), HasSubstr("7")));
}

TEST(ImportObj, NamesTheLineOfAVertexThatIsNotANumber) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(failure(file), AllOf(HasSubstr("a.obj"), HasSubstr("line 2"), HasSubstr("nan")));
}

TEST(ImportObj, DropsMaterialsByNameAndRefusesUnknownNames) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
    const auto file = folder.write(
        "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
    ImportOptions options;
    options.drop_materials = {"b"};
    EXPECT_EQ(import_scene_file(file, options).triangle_count(), 1u);
    options.drop_materials = {"c"};
    EXPECT_THAT(failure(file, options), AllOf(HasSubstr("'c'"), HasSubstr("a, b")));
}

TEST(ImportObj, ScalesToMetres) {
    const TemporaryFolder folder;
    ImportOptions options;
    options.scale = 0.01f;
    const Scene scene = import_scene_file(folder.write("a.obj", triangle_obj), options);
    EXPECT_FLOAT_EQ(scene.bounds().upper.x, 0.01f);
    options.scale = 0.0f;
    EXPECT_THAT(failure(folder.path / "a.obj", options), HasSubstr("scale"));
}

TEST(Import, NamesAFileThatIsNotThere) { EXPECT_THAT(failure("nowhere/x.obj"), HasSubstr("nowhere/x.obj")); }

TEST(Import, RefusesFilesWithoutMeaning) {
    const TemporaryFolder folder;
    for (const char* name : {"empty.obj", "empty.ply", "empty.gltf", "empty.glb", "empty.3ds", "empty.unknown"}) {
        EXPECT_THAT(failure(folder.write(name, "")), HasSubstr(name)) << name;
    }
    EXPECT_THAT(failure(folder.write("points.obj", "v 0 0 0\nv 1 0 0\n")), HasSubstr("points.obj"));
    EXPECT_THAT(failure(folder.write("a.gltf", "{\"asset\": ")), HasSubstr("a.gltf"));
}

std::string ply(int vertices, const std::string& body) {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n{}",
        vertices, body);
}

TEST(ImportPly, ReadsTrianglesAndMakesSmoothNormals) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.ply", ply(3, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_TRUE(import_scene_file(file).meshes[0].normals.empty());
    ImportOptions options;
    options.normals = NormalSource::smooth;
    const Scene scene = import_scene_file(file, options);
    ASSERT_EQ(scene.meshes[0].normals.size(), 3u);
    EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
}

TEST(ImportPly, RefusesIndicesOutOfRangeAndTruncation) {
    const TemporaryFolder folder;
    EXPECT_THAT(failure(folder.write("range.ply", ply(3, "0 0 0\n1 0 0\n0 1 0\n3 0 1 5\n"))), HasSubstr("range.ply"));
    EXPECT_THAT(failure(folder.write("short.ply", ply(3, "0 0 0\n1 0"))), HasSubstr("short.ply"));
    EXPECT_THAT(failure(folder.write("nan.ply", ply(3, "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"))), HasSubstr("nan.ply"));
}

TEST(ImportGltf, ReadsCameraLightsAndEmission) {
    const TemporaryFolder folder;
    ImportOptions options;
    options.scale = 2.0f;
    const Scene scene = import_scene_file(folder.write("a.gltf", gltf()), options);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_FLOAT_EQ(scene.camera("eye").vertical_fov, 0.7f);
    EXPECT_FLOAT_EQ(scene.camera("eye").far_plane, 100.0f);
    EXPECT_NEAR(glm::distance(scene.camera("eye").position(), glm::vec3(0, 0, 10)), 0.0f, 1e-5f);
    ASSERT_EQ(scene.spot_lights.size(), 1u);
    const SpotLight& spot = scene.spot_lights[0];
    EXPECT_NEAR(glm::distance(spot.direction, glm::vec3(0, -1, 0)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(spot.position, glm::vec3(0, 6, 0)), 0.0f, 1e-5f);
    EXPECT_EQ(spot.intensity, glm::vec3(40, 20, 10));  // candela times the square of the scale
    EXPECT_FLOAT_EQ(spot.inner_angle, 0.2f);
    EXPECT_FLOAT_EQ(spot.outer_angle, 0.6f);
    ASSERT_EQ(scene.point_lights.size(), 1u);
    EXPECT_EQ(scene.point_lights[0].intensity, glm::vec3(28));
    EXPECT_EQ(scene.point_lights[0].position, glm::vec3(8, 0, 0));
    ASSERT_EQ(scene.directional_lights.size(), 1u);
    EXPECT_EQ(scene.directional_lights[0].irradiance, glm::vec3(3));
    EXPECT_NEAR(glm::distance(scene.directional_lights[0].direction, glm::vec3(0, 0, -1)), 0.0f, 1e-6f);
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(4, 2, 1));
    EXPECT_FALSE(scene.materials[0].two_sided);
    EXPECT_THAT(scene.import_notes, Contains(AllOf(HasSubstr("NV_materials_mdl"), Not(HasSubstr("KHR")))));
}

TEST(ImportGltf, WritesMirroredInstancesOut) {
    const TemporaryFolder folder;
    const Scene scene = import_scene_file(folder.write("a.gltf", gltf()));
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_THAT(scene.import_notes.front(), HasSubstr("1 mirrored"));
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const auto world = [&](int i) {
            return glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[mesh.triangles[0][i]], 1.0f));
        };
        // A mirror image seen from the side that was its front: +Z before and after.
        EXPECT_GT(glm::cross(world(1) - world(0), world(2) - world(0)).z, 0.0f);
    }
}

TEST(ImportGltf, WhatIsOpaqueStaysAndWhatIsInvisibleGoes) {
    const TemporaryFolder folder;
    const Scene blend = import_scene_file(folder.write("b.gltf", gltf(R"("alphaMode":"BLEND","doubleSided":true)")));
    EXPECT_FALSE(blend.materials[0].is_transparent());
    EXPECT_TRUE(blend.materials[0].two_sided);
    const std::string nothing = R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0]})";
    EXPECT_THAT(failure(folder.write("g.gltf", gltf(nothing))), HasSubstr("no triangle"));
}

}  // namespace
}  // namespace plumb
