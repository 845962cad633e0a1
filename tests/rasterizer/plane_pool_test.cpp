// Planes that share memory do not disturb each other, in whatever formats and layers.
#include "rasterizer/plane_pool.h"

#include <algorithm>
#include <array>

#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/plane_textures.h"
#include "rasterizer/texture_transfer.h"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using PlanePoolTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(PlanePoolTest);

constexpr int width = 9, height = 7;

void fill(const GlTexture& texture, int layer, float value) { upload(texture, layer, Image(width, height, 1, value)); }

bool holds(const GlTexture& texture, int layer, float value) {
    const Image image = read_back(texture, layer, 1);
    return std::ranges::all_of(image.values(), [&](float v) { return v == value; });
}

TEST_P(PlanePoolTest, WhatIsGivenBackIsTakenAgainWithoutMemory) {
    PlanePool pool(context(), width, height);
    const GlTexture& first = pool.take(GL_RGBA16F, 2, 1);
    const std::size_t bytes = context().allocated_bytes();
    const GlTexture& second = pool.take(GL_RGBA16F, 2, 1);
    EXPECT_NE(&first, &second) << "the first is in use";
    EXPECT_EQ(context().allocated_bytes() - bytes, 2u * 8u * width * height);
    pool.give_back(first);
    EXPECT_EQ(&pool.take(GL_RGBA16F, 2, 1), &first);
    EXPECT_EQ(context().allocated_bytes() - bytes, 2u * 8u * width * height);
    pool.give_back(second);
    pool.take(GL_R32F, 1, 1);  // four bytes do not fit into eight
    EXPECT_EQ(context().allocated_bytes() - bytes, (2u * 8u + 4u) * width * height);
}

TEST_P(PlanePoolTest, OtherFormatsAndFewerLayersAreViewsThatLeaveTheRestAlone) {
    PlanePool pool(context(), width, height);
    const GlTexture& three = pool.take(GL_RGBA16F, 3, 1);
    for (int layer = 0; layer < 3; ++layer) fill(three, layer, 1.0f + static_cast<float>(layer));
    pool.give_back(three, 2);
    const std::size_t bytes = context().allocated_bytes();
    const GlTexture& motion = pool.take(GL_RG32F, 1, 1);
    EXPECT_EQ(context().allocated_bytes(), bytes) << "in the third layer";
    EXPECT_EQ(motion.layers(), 1);
    fill(motion, 0, 0.3f);
    EXPECT_TRUE(holds(motion, 0, 0.3f));
    EXPECT_TRUE(holds(three, 0, 1.0f));
    EXPECT_TRUE(holds(three, 1, 2.0f));
    // And drawn into, as a target of its own.
    const GlFramebuffer target(context(), std::array{GlAttachment{&motion}}, {}, "view");
    constexpr std::array<float, 4> value{0.7f, 0.7f, 0.7f, 0.7f};
    context().gl.ClearNamedFramebufferfv(target.id(), GL_COLOR, 0, value.data());
    EXPECT_TRUE(holds(motion, 0, 0.7f));
    EXPECT_TRUE(holds(three, 0, 1.0f));
    EXPECT_TRUE(holds(three, 1, 2.0f));
    pool.give_back(three);
    pool.take(GL_RGBA16F, 2, 1);
    EXPECT_EQ(context().allocated_bytes(), bytes) << "the other two";
}

TEST_P(PlanePoolTest, ASingleLevelFitsIntoAChainAndNotTheOtherWayRound) {
    PlanePool pool(context(), width, height);
    pool.give_back(pool.take(GL_R32F, 1, 3));
    std::size_t bytes = context().allocated_bytes();
    const GlTexture& single = pool.take(GL_R11F_G11F_B10F, 1, 1);
    EXPECT_EQ(context().allocated_bytes(), bytes);
    EXPECT_EQ(single.levels(), 1);
    pool.give_back(single);
    pool.give_back(pool.take(GL_RGBA32F, 1, 1));
    bytes = context().allocated_bytes();
    pool.take(GL_RGBA32F, 1, 2);
    EXPECT_GT(context().allocated_bytes(), bytes);
}

// What a plane held before may be others' memory but for the passes between which it matters; whatever they write,
// through views or not, the plane keeps. Two planes of a shape share what they held before.
TEST_P(PlanePoolTest, WhatAPlaneHeldBeforeIsOthersMemoryUntilTheyTradePlaces) {
    PlanePool pool(context(), width, height);
    GlTexture first = GlTexture::array(context(), GL_R32F, width, height, 2),
              second = GlTexture::array(context(), GL_R32F, width, height, 2);
    first.set_trading(), second.set_trading();
    GlTexture& early = pool.take(GL_R32F, 2, 1);
    pool.give_back(early);
    GlTexture& narrow = pool.take(GL_R11F_G11F_B10F, 1, 1);
    const GlFramebuffer drawn(context(), std::array{GlAttachment{&narrow, 0}}, {}, "view"),
        kept(context(), std::array{GlAttachment{&first, 1}}, {}, "kept");
    pool.give_back(narrow);
    const std::size_t bytes = context().allocated_bytes();
    const PooledHistory one = pool.take_history(first);
    EXPECT_EQ(one.taken, &early);
    pool.give_back(early);
    const PooledHistory other = pool.take_history(second);
    EXPECT_EQ(other.taken, &early);
    pool.give_back(early);
    GlTexture& late = pool.take(GL_RGBA8, 2, 1);
    EXPECT_EQ(context().allocated_bytes(), bytes);

    const auto clear = [&](const GlFramebuffer& target, float value) {
        const std::array<float, 4> values{value, value, value, value};
        context().gl.ClearNamedFramebufferfv(target.id(), GL_COLOR, 0, values.data());
    };
    for (int frame = 0; frame < 4; ++frame) {
        SCOPED_TRACE(frame);
        const float value = 1.0f + static_cast<float>(frame);
        fill(early, 0, -1.0f), fill(early, 1, -1.0f);
        clear(drawn, 0.5f);
        EXPECT_TRUE(holds(narrow, 0, 0.5f));
        one.history.trade_places();
        EXPECT_TRUE(frame == 0 || holds(early, 1, value - 1.0f)) << "before";
        clear(kept, value);
        other.history.trade_places();
        EXPECT_TRUE(frame == 0 || holds(early, 0, 10.0f * value - 10.0f)) << "before, of the other";
        fill(second, 0, 10.0f * value);
        upload(late, 0, Image(width, height, 4, 0.2f)), upload(late, 1, Image(width, height, 4, 0.2f));
        EXPECT_TRUE(holds(first, 1, value));
        EXPECT_TRUE(holds(second, 0, 10.0f * value));
    }
}

TEST_P(PlanePoolTest, APlaneThatWasGivenUpIsNotFoundAndOneWithAHistoryIsNotShared) {
    PlaneTextures planes(context(), width, height,
                         {.within_frame = {"noise", "light"}, .in_place = {{"light", "noise"}}});
    const auto error = [](const auto& action) -> std::string {
        try {
            action();
        } catch (const GlError& e) {
            return e.what();
        }
        return "no error";
    };
    const GlTexture& noise = planes.create("noise", GL_R32F, 1);
    EXPECT_EQ(&planes.create("light", GL_R32F, 1), &noise) << "overwrites it";
    EXPECT_THAT(error([&] { planes.create_history("light", "light.previous"); }), HasSubstr("declares it as kept"));
    planes.create("depth", GL_R32F, 1);
    EXPECT_EQ(error([&] { planes.create_history("depth", "previous_depth"); }), "no error");
    planes.give_up({"depth"});  // which is its own
    EXPECT_TRUE(planes.has("depth"));
    planes.give_up({"noise", 1});  // it has only one layer
    EXPECT_TRUE(planes.has("noise"));
    planes.give_up({"noise"});
    EXPECT_THAT(error([&] { planes.get("noise"); }), HasSubstr("'noise' was given up"));
}

PassDeclaration pass(std::string name, std::vector<std::string> inputs, std::vector<std::string> outputs) {
    PassDeclaration declaration;
    declaration.name = std::move(name);
    declaration.inputs = std::move(inputs);
    declaration.outputs = std::move(outputs);
    return declaration;
}

// Of which nothing is left once the pass at `position` has run.
std::vector<std::string> ended(const PlaneLifetimes& lifetimes, std::size_t position, int first_layer = 0) {
    std::vector<std::string> names;
    for (const PlaneLifetimes::Ended& one : lifetimes.ended_after.at(position)) {
        if (one.first_layer == first_layer) names.push_back(one.plane);
    }
    return names;
}

TEST(PlaneLifetimes, EndWithTheLastPassThatNamesALayer) {
    std::vector<PassDeclaration> passes{pass("a", {}, {"x", "layer2.x"}), pass("b", {"layer2.x"}, {"y"}),
                                        pass("c", {"x", "y"}, {"z"}), pass("unread", {"z"}, {"w"}),
                                        pass("d", {"z"}, {"total"})};
    passes[2].scratch = {"s"};
    const PlaneLifetimes plain = plan_passes(passes, {"total"}).lifetimes;
    EXPECT_THAT(plain.within_frame, UnorderedElementsAre("x", "y", "z", "s", "total"));
    ASSERT_EQ(plain.ended_after.size(), 4u);
    EXPECT_THAT(ended(plain, 0), IsEmpty());
    EXPECT_THAT(ended(plain, 0, 2), ElementsAre("x")) << "a third layer, which nobody names";
    EXPECT_THAT(ended(plain, 1), IsEmpty());
    EXPECT_THAT(ended(plain, 1, 1), UnorderedElementsAre("x", "y")) << "its second layer is read no more";
    EXPECT_THAT(ended(plain, 2), UnorderedElementsAre("x", "y", "s"));
    EXPECT_THAT(ended(plain, 3), ElementsAre("z")) << "total is read back";

    passes[1].kept = {"y"};
    EXPECT_FALSE(plan_passes(passes, {"total"}).lifetimes.within_frame.contains("y"));
    EXPECT_THAT(ended(plan_passes(passes, {"total"}).lifetimes, 2), UnorderedElementsAre("x", "s"));
}

TEST(PlaneLifetimes, TheFirstLayerMayEndBeforeTheSecondWhichKeepsIt) {
    const std::vector<PassDeclaration> passes{pass("a", {}, {"x", "layer2.x"}), pass("b", {"x"}, {"y"}),
                                              pass("c", {"layer2.x", "y"}, {"total"})};
    const PlaneLifetimes lifetimes = plan_passes(passes, {"total"}).lifetimes;
    EXPECT_THAT(ended(lifetimes, 1), IsEmpty());
    EXPECT_THAT(ended(lifetimes, 2), UnorderedElementsAre("x", "y"));
}

TEST(PlaneLifetimes, WhatIsOverwrittenMustBeOfNoUseToOthers) {
    std::vector<PassDeclaration> passes{pass("gather", {}, {"noise"}), pass("blur", {"noise"}, {"smooth"}),
                                        pass("show", {"smooth"}, {"total"})};
    passes[1].in_place = PassDeclaration::InPlace{.output = "smooth", .input = "noise"};
    const PlaneLifetimes lifetimes = plan_passes(passes, {"total"}).lifetimes;
    EXPECT_EQ(lifetimes.in_place.at("smooth"), "noise");
    EXPECT_THAT(lifetimes.chained, IsEmpty());
    EXPECT_THAT(ended(lifetimes, 1), IsEmpty());
    EXPECT_THAT(ended(lifetimes, 2), UnorderedElementsAre("noise", "smooth"));
    EXPECT_THAT(plan_passes(passes, {"total", "noise"}).lifetimes.in_place, IsEmpty()) << "asked for";
    passes[2].inputs.emplace_back("noise");
    EXPECT_THAT(plan_passes(passes, {"total"}).lifetimes.in_place, IsEmpty()) << "read by another pass";
    passes[2].inputs.pop_back();
    passes[2].kept = {"smooth"};
    EXPECT_THAT(plan_passes(passes, {"total"}).lifetimes.in_place, IsEmpty()) << "needed in the next frame";
}

TEST(PlaneLifetimes, AChainIsThePlaneItselfWhoeverElseReadsIt) {
    std::vector<PassDeclaration> passes{pass("a", {}, {"x", "layer2.x"}), pass("chain", {"x"}, {"x_chain"}),
                                        pass("gather", {"x_chain"}, {"y"}),
                                        pass("light", {"x", "layer2.x", "y"}, {"z"}), pass("show", {"z"}, {"total"})};
    passes[1].in_place = PassDeclaration::InPlace{.output = "x_chain", .input = "x", .is_chain = true};
    const PlaneLifetimes lifetimes = plan_passes(passes, {"total"}).lifetimes;
    EXPECT_EQ(lifetimes.in_place.at("x_chain"), "x");
    EXPECT_THAT(lifetimes.chained, UnorderedElementsAre("x"));
    EXPECT_THAT(ended(lifetimes, 2), IsEmpty()) << "the chain is read no more, and is more than a chain";
    EXPECT_THAT(ended(lifetimes, 3), UnorderedElementsAre("x", "x_chain", "y"));
    EXPECT_THAT(ended(plan_passes(passes, {"total", "x"}).lifetimes, 3), ElementsAre("y")) << "asked for";
    passes[0].kept = {"x"};
    EXPECT_THAT(plan_passes(passes, {"total"}).lifetimes.in_place, IsEmpty()) << "its memory is its own";
}

}  // namespace
}  // namespace plumb
