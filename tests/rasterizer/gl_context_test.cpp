#include "rasterizer/gl_context.h"

#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/gl_objects.h"
#include "rasterizer/texture_transfer.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using GlContextTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(GlContextTest);

TEST_P(GlContextTest, StartsWithCoreProfile45OrLater) {
    GLint major = 0, minor = 0, profile = 0;
    context().gl.GetIntegerv(GL_MAJOR_VERSION, &major);
    context().gl.GetIntegerv(GL_MINOR_VERSION, &minor);
    context().gl.GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(10 * major + minor, 45) << context().info().version;
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_EQ(context().info().backend, GetParam());
    EXPECT_FALSE(context().info().renderer.empty());
    EXPECT_FALSE(context().info().extensions.empty());
}

TEST_P(GlContextTest, NamesThePassOfAnError) {
    context().gl.BindBuffer(GL_TEXTURE_2D, 0);  // not a buffer target
    try {
        context().check("a broken pass");
        FAIL() << "no exception";
    } catch (const GlError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a broken pass"));
        EXPECT_THAT(error.what(), HasSubstr("GL_INVALID_ENUM"));
        EXPECT_THAT(error.what(), HasSubstr("glBindBuffer"));  // from the debug message
    }
    EXPECT_NO_THROW(context().check("the next pass"));
}

TEST_P(GlContextTest, ReleaseContextReportsErrorsWithoutDebugOutput) {
    const auto release = GlContext::create(GetParam(), false);
    release->gl.BindBuffer(GL_TEXTURE_2D, 0);
    EXPECT_THROW(release->check("a broken pass"), GlError);
}

TEST_P(GlContextTest, CountsTheBytesOfLivingObjects) {
    const std::size_t before = context().allocated_bytes();
    {
        GlTexture texture = GlTexture::array(context(), GL_RGBA16F, 16, 8, 2);
        EXPECT_EQ(context().allocated_bytes() - before, 16u * 8 * 2 * 8);
        GlTexture moved = std::move(texture);
        EXPECT_EQ(context().allocated_bytes() - before, 16u * 8 * 2 * 8);
        EXPECT_EQ(texture.id(), 0u);  // NOLINT(bugprone-use-after-move): what moving leaves
        moved = GlTexture::flat(context(), GL_R32F, 4, 4, 3);
        EXPECT_EQ(context().allocated_bytes() - before, (16u + 4 + 1) * 4);
        const GlBuffer buffer(context(), 100, nullptr, GL_DYNAMIC_STORAGE_BIT);
        EXPECT_EQ(context().allocated_bytes() - before, (16u + 4 + 1) * 4 + 100);
    }
    EXPECT_EQ(context().allocated_bytes(), before);
}

TEST_P(GlContextTest, MovedFromObjectsAreDeletedOnce) {
    GLuint id = 0;
    {
        GlTexture first = GlTexture::flat(context(), GL_R8, 4, 4);
        id = first.id();
        const GlTexture second = std::move(first);
        EXPECT_TRUE(context().gl.IsTexture(id));
    }
    EXPECT_FALSE(context().gl.IsTexture(id));
}

TEST_P(GlContextTest, TransferFlipsRowsBothWays) {
    Image image(3, 2, 2);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 3; ++x) image.at(x, y, 0) = static_cast<float>(10 * y + x), image.at(x, y, 1) = -1.0f;
    }
    const GlTexture texture = GlTexture::array(context(), GL_RG32F, 3, 2, 2);
    upload(texture, 1, image);
    const Image back = read_back(texture, 1, 2);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 3; ++x) EXPECT_EQ(back.at(x, y), image.at(x, y)) << x << ", " << y;
    }
    // OpenGL's first row is the image's last.
    float first[2] = {};
    context().gl.GetTextureSubImage(texture.id(), 0, 0, 0, 1, 1, 1, 1, GL_RG, GL_FLOAT, sizeof first, first);
    EXPECT_EQ(first[0], 10.0f);
}

TEST_P(GlContextTest, IncompleteFramebufferNamesItsPurpose) {
    const GlTexture small = GlTexture::flat(context(), GL_RGBA8, 4, 4);
    const GlAttachment wrong[] = {{&small, 0, 3}};  // there is no level 3
    try {
        const GlFramebuffer framebuffer(context(), wrong, {}, "the test");
        FAIL() << "no exception";
    } catch (const GlError& error) {
        EXPECT_THAT(error.what(), HasSubstr("the test"));
    }
    EXPECT_THROW(context().check("clean up"), GlError);
}

TEST(GlContexts, BothKindsLiveSideBySide) {
    GlContext& egl = test_context(GlBackend::egl);
    GlTexture in_egl = GlTexture::flat(egl, GL_R32F, 2, 2);
    upload(in_egl, 0, Image(2, 2, 1, 1.0f));
    GlContext& osmesa = test_context(GlBackend::osmesa);
    GlTexture in_osmesa = GlTexture::flat(osmesa, GL_R32F, 2, 2);
    upload(in_osmesa, 0, Image(2, 2, 1, 2.0f));
    for (int turn = 0; turn < 3; ++turn) {
        EXPECT_EQ(read_back(in_egl, 0, 1).at(0, 0), 1.0f);
        EXPECT_EQ(read_back(in_osmesa, 0, 1).at(0, 0), 2.0f);
    }
}

TEST(GlContexts, ProbeReportsEveryBackend) {
    const std::vector<GlBackendReport> reports = GlContext::probe();
    ASSERT_GE(reports.size(), 2u);
    EXPECT_EQ(reports.back().backend, GlBackend::osmesa);
    for (const GlBackendReport& report : reports) {
        EXPECT_NE(report.starts, report.info.renderer.empty()) << report.platform;
        EXPECT_NE(report.starts, !report.problem.empty()) << report.platform << ": " << report.problem;
    }
}

}  // namespace
}  // namespace plumb
