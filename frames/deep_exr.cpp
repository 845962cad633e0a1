#include "frames/deep_exr.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include "frames/channel_names.h"
#include "frames/exr_writing.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

std::string layer_prefix_of(int layer) { return layer == 0 ? "" : fmt::format("layer{}.", layer + 1); }

bool is_of_deeper_layer(const std::string& plane, int layers) {
    for (int layer = 1; layer < layers; ++layer) {
        if (plane.starts_with(layer_prefix_of(layer))) return true;
    }
    return false;
}

// One channel: its samples, pixel after pixel, and where each pixel's begin.
struct DeepChannel {
    std::vector<float> samples;
    std::vector<float*> pixels;
};

class DeepImage {
public:
    explicit DeepImage(const Frame& frame) : frame_(frame) {
        while (frame.has(layer_prefix_of(layers_) + "depth")) ++layers_;
        for (int layer = 0; layer < layers_; ++layer) depths_.push_back(&frame.plane(layer_prefix_of(layer) + "depth"));
        counts_.resize(depths_.empty() ? 0 : depths_.front()->pixel_count());
        for (const Image* depth : depths_) {
            for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += std::isfinite(depth->values()[i]) ? 1u : 0u;
        }
    }

    int layers() const { return layers_; }
    bool every_layer_has(const std::string& plane) const {
        for (int layer = 0; layer < layers_; ++layer) {
            if (!frame_.has(layer_prefix_of(layer) + plane)) return false;
        }
        return true;
    }

    void add(const std::string& channel, const std::string& plane, int component) {
        DeepChannel& deep = begin(channel);
        for_each_sample([&](int layer, int x, int y) {
            deep.samples.push_back(frame_.plane(layer_prefix_of(layer) + plane).at(x, y, component));
        });
        finish(channel, deep);
    }
    void add_constant(const std::string& channel, float value) {
        DeepChannel& deep = begin(channel);
        for_each_sample([&](int, int, int) { deep.samples.push_back(value); });
        finish(channel, deep);
    }

    void write(Imf::OStream& stream, Imf::Header header) {
        for (const std::string& name : names_) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile output(stream, header);
        output.setFrameBuffer(buffer_);
        output.writePixels(frame_.height());
    }

private:
    DeepChannel& begin(const std::string& channel) {
        names_.push_back(channel);
        return channels_.emplace_back();
    }
    template <typename Action>
    void for_each_sample(const Action& action) const {
        for (int y = 0; y < frame_.height(); ++y) {
            for (int x = 0; x < frame_.width(); ++x) {
                for (int layer = 0; layer < layers_; ++layer) {
                    if (std::isfinite(depths_[static_cast<std::size_t>(layer)]->at(x, y))) action(layer, x, y);
                }
            }
        }
    }
    void finish(const std::string& name, DeepChannel& channel) {
        float* sample = channel.samples.data();
        for (const unsigned count : counts_) channel.pixels.push_back(sample), sample += count;
        const std::size_t width = static_cast<std::size_t>(frame_.width());
        if (names_.size() == 1) {
            buffer_.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts_.data()),
                                                      sizeof(unsigned), sizeof(unsigned) * width));
        }
        buffer_.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(channel.pixels.data()), sizeof(float*),
                                            sizeof(float*) * width, sizeof(float)));
    }

    const Frame& frame_;
    int layers_ = 0;
    std::vector<const Image*> depths_;
    std::vector<unsigned> counts_;  // samples of each pixel
    std::vector<std::string> names_;
    std::deque<DeepChannel> channels_;  // OpenEXR keeps pointers into them
    Imf::DeepFrameBuffer buffer_;
};

}  // namespace

std::vector<std::string> write_deep_exr(const std::filesystem::path& path, const Frame& frame) {
    DeepImage image(frame);
    if (image.layers() == 0) {
        throw ImageError(
            fmt::format("cannot write '{}': the frame has no plane 'depth', without which no sample has a "
                        "place; render it too, and layer2.depth for a second layer",
                        path.string()));
    }
    Imf::Header header(frame.width(), frame.height());
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.setType(Imf::DEEPSCANLINE);
    add_facts(path, frame, header);

    image.add("Z", "depth", 0);
    image.add_constant("A", 1.0f);
    for (const std::string plane : {"total", "direct", "albedo"}) {
        if (!image.every_layer_has(plane) || frame.plane(plane).channels() != 3) continue;
        int component = 0;
        for (const char* channel : {"R", "G", "B"}) image.add(channel, plane, component++);
        break;
    }
    std::vector<std::string> left_out;
    for (const std::string& plane : frame.plane_names()) {
        if (plane == "depth") continue;
        if (is_of_deeper_layer(plane, image.layers())) {
            const std::string base = plane.substr(plane.find('.') + 1);
            if (!image.every_layer_has(base)) left_out.push_back(plane);
        } else if (!image.every_layer_has(plane)) {
            left_out.push_back(plane);
        } else if (plane != "total") {  // which is R, G, B by name
            const auto names = channel_names(plane, frame.plane(plane).channels());
            for (std::size_t i = 0; i < names.size(); ++i) image.add(names[i], plane, static_cast<int>(i));
        }
    }
    write_exr_atomically(path, [&](Imf::OStream& stream) { image.write(stream, header); });
    return left_out;
}

}  // namespace plumb
