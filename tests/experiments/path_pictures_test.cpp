#include "experiments/path_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/picture_look.h"
#include "frames/colour_map.h"
#include "frames/image_error.h"
#include "frames/image_file.h"
#include "tests/experiments/page_sample.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

TEST(PathPictures, WritesAStripOfFilesForTruthMethodsAndErrors) {
    const TemporaryFolder folder;
    const PathPictures path = sample_path(folder.path);
    ASSERT_THAT(path.strips, SizeIs(5));
    EXPECT_EQ(path.strips[0].kind + path.strips[1].kind + path.strips[2].kind, "truthmethoderror");
    EXPECT_EQ(path.strips[3].label, "two");
    for (const PathPictureStrip& strip : path.strips) EXPECT_THAT(strip.files, SizeIs(sample_frames));
    EXPECT_EQ(path.strips[1].files[2], "pictures/cornell.orbit.ao.one.0002.jpg");
    EXPECT_DOUBLE_EQ(path.error_scale, 0.1) << "the greatest error, that of method one";

    // Display values as sRGB; 4 of 255 levels for JPEG at quality 88.
    const Image truth = read_frame(folder.path / path.strips[0].files[3]).plane("total");
    EXPECT_NEAR(linear_to_srgb(truth.at(16, 9, 0)), 0.6, 4.0 / 255);
    const Image error = read_frame(folder.path / path.strips[4].files[3]).plane("total");
    const auto colour = colour_at(error_colour_map, 0.2f);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(linear_to_srgb(error.at(16, 9, c)), colour[c], 4.0 / 255) << "channel " << c;
}

TEST(PathPictures, MakesWideFramesSmaller) {
    const TemporaryFolder folder;
    const Image frame(1000, 500, 3, 0.25f);
    PathPictures subject;
    subject.scene = "s", subject.path = "p", subject.plane = "total";
    const PathPictures path = write_path_pictures(subject, {&frame}, {}, folder.path);
    const Frame written = read_frame(folder.path / path.strips[0].files[0]);
    EXPECT_EQ(written.width(), 480);
    EXPECT_EQ(written.height(), 240);
    EXPECT_THAT(path.exposure_note, HasSubstr("exposure +1.8 stops")) << "log2(0.9 / 0.25) = 1.848";
}

TEST(PathPictures, RefusesMethodsOfAnotherLength) {
    const TemporaryFolder folder;
    const Image frame(8, 8, 1, 0.5f);
    PathPictures subject;
    subject.scene = "s", subject.path = "p", subject.plane = "ao";
    PathImages method;
    method.label = "short";
    EXPECT_THAT([&] { write_path_pictures(subject, {&frame}, {method}, folder.path); },
                ThrowsMessage<ImageError>(HasSubstr("s / p / ao: short has 0 frames, the truth 1")));
}

TEST(PictureLook, ScalesReadWell) {
    EXPECT_DOUBLE_EQ(round_up_scale(0.0123), 0.015);
    EXPECT_DOUBLE_EQ(round_up_scale(0.4), 0.4);
    EXPECT_DOUBLE_EQ(round_up_scale(9.5), 10.0);
    EXPECT_DOUBLE_EQ(round_up_scale(0.0), 1e-6);
    EXPECT_EQ(file_name_of("two layers/1"), "two_layers_1");
}

}  // namespace
}  // namespace plumb
