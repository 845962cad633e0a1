#include "scenes/repair.h"

#include <limits>

#include <gmock/gmock.h>

#include "scenes/scene_error.h"
#include "scenes/smooth_normals.h"
#include "scenes/validate.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Mesh square() {
    Mesh mesh;
    mesh.name = "square";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TEST(Repair, LeavesAGoodMeshAlone) {
    Mesh mesh = square();
    mesh.normals.assign(4, {0, 0, 1});
    EXPECT_TRUE(repair(mesh, "f.obj").nothing());
    EXPECT_EQ(mesh.triangles, square().triangles);
}

TEST(Repair, DropsZeroAreaAndHairThinTriangles) {
    Mesh mesh = square();
    mesh.positions.push_back({0.5f, 0.5f, 0.0f});     // on the diagonal
    mesh.positions.push_back({0.25f, 0.25f, 1e-9f});  // thinner than the rounding of coordinates near 1
    mesh.triangles.push_back({0, 2, 4});
    mesh.triangles.push_back({0, 2, 5});
    mesh.triangles.push_back({0, 0, 1});
    const RepairCounts counts = repair(mesh, "f.obj");
    EXPECT_EQ(counts.zero_area_dropped, 3u);
    EXPECT_EQ(counts.vertices_dropped, 2u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Repair, KeepsSmallTrianglesThatAreNotThin) {
    Mesh mesh = square();
    for (glm::vec3& p : mesh.positions) p *= 1e-6f;
    EXPECT_EQ(repair(mesh, "f.obj").zero_area_dropped, 0u);
}

TEST(Repair, DropsDuplicatesByPositionWhateverTheirOrder) {
    Mesh mesh = square();
    mesh.positions.push_back({0, 0, 0});
    mesh.triangles.push_back({1, 2, 4});  // the first again, turned and through another vertex
    mesh.triangles.push_back({1, 0, 2});  // and from behind
    EXPECT_EQ(repair(mesh, "f.obj").duplicates_dropped, 2u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Repair, KeepsBackToBackTrianglesOfOneSidedMaterials) {
    Mesh mesh = square();
    mesh.triangles.push_back({1, 0, 2});
    EXPECT_EQ(repair(mesh, "f.obj", false).duplicates_dropped, 0u);
}

TEST(Repair, RewindsTrianglesAgainstTheirNormals) {
    Mesh mesh = square();
    mesh.normals.assign(4, {0, 0, -1});
    EXPECT_EQ(repair(mesh, "f.obj").rewound, 2u);
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 2, 1));
}

TEST(Repair, ReplacesUnusableNormalsByTheFaceNormal) {
    Mesh mesh = square();
    mesh.normals = {{0, 0, 0}, {0, 0, 2}, {not_a_number, 0, 0}, {0, 0, 1}};
    const RepairCounts counts = repair(mesh, "f.obj");
    EXPECT_EQ(counts.normals_replaced, 4u);  // two vertices in two triangles each
    EXPECT_EQ(counts.vertices_dropped, 0u);
    for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(Repair, NamesAnIndexOutOfRange) {
    Mesh mesh = square();
    mesh.triangles.push_back({0, 1, 9});
    EXPECT_THAT(message_of<SceneError>([&] { repair(mesh, "f.obj"); }),
                AllOf(HasSubstr("f.obj"), HasSubstr("'square'"), HasSubstr("triangle 2"), HasSubstr("index 9")));
}

TEST(Repair, NamesAVertexThatIsNotFinite) {
    Mesh mesh = square();
    mesh.positions[3].y = not_a_number;
    EXPECT_THAT(message_of<SceneError>([&] { repair(mesh, "f.obj"); }),
                AllOf(HasSubstr("f.obj"), HasSubstr("triangle 1"), HasSubstr("vertex 3"), HasSubstr("nan")));
}

TEST(SmoothNormals, ACubeStaysSharpBelowItsCreaseAndIsRoundAboveIt) {
    Mesh cube;
    for (int i = 0; i < 8; ++i) cube.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    cube.triangles = {{1, 3, 7}, {1, 7, 5}, {0, 4, 6}, {0, 6, 2}, {2, 6, 7}, {2, 7, 3},
                      {0, 1, 5}, {0, 5, 4}, {4, 5, 7}, {4, 7, 6}, {0, 2, 3}, {0, 3, 1}};
    Mesh sharp = cube, round = cube;
    make_smooth_normals(sharp, glm::radians(60.0f));
    EXPECT_EQ(sharp.positions.size(), 24u);
    make_smooth_normals(round, glm::radians(91.0f));
    ASSERT_EQ(round.positions.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        // Angle weights make the corner normal the diagonal, whatever the triangulation; 1e-6 for float rounding.
        EXPECT_NEAR(glm::distance(round.normals[i], glm::normalize(round.positions[i])), 0.0f, 1e-6f);
    }
}

TEST(Validate, NamesWhatIsWrong) {
    Scene good;
    good.name = "s";
    good.materials = {Material{}};
    good.meshes = {square()};
    good.instances = {{"i", 0, glm::mat4(1.0f)}};
    EXPECT_NO_THROW(validate(good));
    const auto message = [&](auto&& change) {
        Scene scene = good;
        change(scene);
        return message_of<SceneError>([&] { validate(scene); });
    };
    EXPECT_THAT(message([](Scene& s) { s.meshes[0].material = 3; }), HasSubstr("material 3"));
    EXPECT_THAT(message([](Scene& s) { s.instances[0].mesh = 1; }), HasSubstr("mesh 1"));
    EXPECT_THAT(message([](Scene& s) { s.instances[0].world_from_object[0].x = -1; }), HasSubstr("determinant -1"));
    EXPECT_THAT(message([](Scene& s) { s.materials[0].base_colour.x = 1.5f; }), HasSubstr("1.5"));
    EXPECT_THAT(message([](Scene& s) { s.materials[0].emission_texture = 0; }), HasSubstr("texture 0"));
    EXPECT_THAT(message([](Scene& s) { s.meshes[0].normals.assign(4, {0, 0, -1}); }), HasSubstr("wound"));
    EXPECT_THAT(message([](Scene& s) { s.meshes[0].normals.assign(4, {0, 0, 2}); }), HasSubstr("length 2"));
    EXPECT_THAT(message([](Scene& s) { s.point_lights = {{"l", {0, 0, 0}, {-1, 0, 0}}}; }), HasSubstr("-1"));
    EXPECT_THAT(message([](Scene& s) { s.directional_lights = {{"sun", {0, -2, 0}, {1, 1, 1}}}; }), HasSubstr("'sun'"));
}

}  // namespace
}  // namespace plumb
