#include "frames/exr.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include "frames/channel_names.h"
#include "frames/exr_writing.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

constexpr std::string_view fact_prefix = exr_fact_prefix;
constexpr std::size_t longest_name = longest_exr_name;

Imf::Header make_header(const std::filesystem::path& path, const Frame& frame) {
    Imf::Header header(frame.width(), frame.height());
    header.compression() = Imf::ZIP_COMPRESSION;
    add_facts(path, frame, header);
    return header;
}

// Channels and where their values lie; OpenEXR reads the interleaved planes in place.
void add_plane(const std::filesystem::path& path, const std::string& name, const Image& image, Imf::Header& header,
               Imf::FrameBuffer& buffer) {
    const auto names = channel_names(name, image.channels());
    for (int i = 0; i < image.channels(); ++i) {
        if (names[i].size() > longest_name) {
            throw ImageError(fmt::format("cannot write '{}': the name of plane '{}' has more than {} characters",
                                         path.string(), name, longest_name - 8));
        }
        header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
        const std::size_t pixel = sizeof(float) * image.channels();
        // The frame buffer's pointer is not const because reading uses the same type; writing only reads from it.
        auto* base = reinterpret_cast<char*>(const_cast<float*>(image.values().data() + i));
        buffer.insert(names[i], Imf::Slice(Imf::FLOAT, base, pixel, pixel * image.width()));
    }
}

// OpenEXR keeps two blocks of 16 lines per thread, with all channels: of frames with very many as few as fit 128 MiB.
int writing_threads(const Frame& frame) {
    std::size_t channels = 0;
    for (const std::string& name : frame.plane_names()) {
        channels += static_cast<std::size_t>(frame.plane(name).channels());
    }
    const std::size_t per_thread =
        std::size_t{2} * 16 * sizeof(float) * channels * static_cast<std::size_t>(frame.width());
    const auto affordable = static_cast<int>(std::max<std::size_t>(1, (std::size_t{128} << 20) / per_thread));
    return std::min(affordable, Imf::globalThreadCount());
}

// Files that OpenEXR would refuse in its own words, or for which it would ask for absurd amounts of memory.
void check_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) cannot_read(path, "there is no such file; check the path");
    if (!std::filesystem::is_regular_file(status)) cannot_read(path, "it is not a file; name a file inside it");
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) cannot_read(path, fmt::format("{}; check its permissions", std::strerror(errno)));
    unsigned char start[4] = {};
    const std::size_t count = std::fread(start, 1, 4, file);
    std::fclose(file);
    if (count == 0) cannot_read(path, "it is empty (0 bytes); write it again");
    constexpr unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    if (count < 4 || std::memcmp(start, magic, 4) != 0) {
        cannot_read(path, "it is not an OpenEXR file, whatever its name; give an .exr file");
    }
}

struct Window {
    int x0, y0, x1, y1;  // inclusive
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    bool operator==(const Window&) const = default;
};

Window window_of(const Imath::Box2i& box) { return {box.min.x, box.min.y, box.max.x, box.max.y}; }

Window intersect(const Window& a, const Window& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Image crop(const Image& image, int x0, int y0, int width, int height) {
    Image result(width, height, image.channels());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) std::ranges::copy(image.pixel(x0 + x, y0 + y), result.pixel(x, y).begin());
    }
    return result;
}

// Reads all parts of one open file into one frame.
class Reader {
public:
    Reader(const std::filesystem::path& path, Imf::MultiPartInputFile& file) : path_(path), file_(file) {}

    Frame read() {
        for (int part = 0; part < file_.parts(); ++part) read_part(part);
        if (!frame_ || frame_->plane_names().empty()) cannot_read(path_, "it has no channels");
        return std::move(*frame_);
    }

private:
    void read_part(int index) {
        const Imf::Header& header = file_.header(index);
        const std::string part = header.hasName() ? header.name() : fmt::format("part{}", index);
        if (header.hasType() && Imf::isDeepData(header.type())) {
            cannot_read(path_, fmt::format("part '{}' holds deep data; flatten it first (oiiotool --flatten)", part));
        }
        const Window data = window_of(header.dataWindow()), display = window_of(header.displayWindow());
        const Window seen = intersect(data, display);
        if (seen.width() < 1 || seen.height() < 1) {
            cannot_read(path_, fmt::format("the data of part '{}' lies outside its display window", part));
        }
        check_memory(header, data);
        begin_frame(part, seen, data, display);
        if (index == 0) read_facts(header);

        const auto names = full_names(index, part, header);
        std::vector<std::string> list;
        list.reserve(names.size());
        for (const auto& [full, name] : names) list.push_back(full);
        const auto groups = group_channels(list);
        Imf::FrameBuffer buffer;
        std::map<std::string, Image> images;
        for (const auto& group : groups) {
            const auto [position, is_new] =
                images.try_emplace(group.plane, data.width(), data.height(), static_cast<int>(group.channels.size()));
            if (!is_new)
                cannot_read(path_, fmt::format("two of its layers make up a plane '{}'; rename one", group.plane));
            Image& image = position->second;
            const std::size_t pixel = sizeof(float) * image.channels();
            for (int i = 0; i < image.channels(); ++i) {
                auto* base = reinterpret_cast<char*>(image.values().data() + i);
                buffer.insert(names.at(group.channels[i]),
                              Imf::Slice::Make(Imf::FLOAT, base, header.dataWindow(), pixel, pixel * data.width()));
            }
        }
        Imf::InputPart input(file_, index);
        input.setFrameBuffer(buffer);
        input.readPixels(data.y0, data.y1);
        for (auto& [plane, image] : images) {
            if (frame_->has(plane)) {
                cannot_read(path_,
                            fmt::format("two of its parts have a plane '{}'; rename one or split the file", plane));
            }
            const bool whole = seen == data;
            frame_->set(plane, whole ? std::move(image)
                                     : crop(image, seen.x0 - data.x0, seen.y0 - data.y0, seen.width(), seen.height()));
        }
    }

    // A damaged header can claim any size. No compression of the format exceeds 1 : 100000 (the flattest frames reach
    // about 1 : 10000 with DWAB), so that larger claims are lies.
    void check_memory(const Imf::Header& header, const Window& data) const {
        double channels = 0;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) ++channels;
        const double bytes = channels * sizeof(float) * data.width() * data.height();
        if (bytes > 1e5 * static_cast<double>(std::filesystem::file_size(path_))) {
            cannot_read(path_,
                        fmt::format("it claims {}x{} pixels but is far too short for them: truncated or damaged; "
                                    "write it again",
                                    data.width(), data.height()));
        }
    }

    void begin_frame(const std::string& part, const Window& seen, const Window& data, const Window& display) {
        if (!frame_) {
            frame_.emplace(seen.width(), seen.height());
            seen_ = seen;
            if (seen != display) {
                frame_->facts["data_window"] =
                    fmt::format("{}x{} at {},{} of {}x{}", seen.width(), seen.height(), seen.x0 - display.x0,
                                seen.y0 - display.y0, display.width(), display.height());
            }
        } else if (seen != seen_) {
            cannot_read(path_,
                        fmt::format("part '{}' covers {}x{} pixels at {},{}, the first part {}x{} at {},{}; split "
                                    "the file by part (oiiotool --subimage)",
                                    part, seen.width(), seen.height(), data.x0, data.y0, seen_.width(), seen_.height(),
                                    seen_.x0, seen_.y0));
        }
    }

    void read_facts(const Imf::Header& header) {
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
            const std::string_view name = attribute.name();
            const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
            if (text && name.starts_with(fact_prefix)) {
                frame_->facts[std::string(name.substr(fact_prefix.size()))] = text->value();
            }
        }
    }

    // Name with layer -> name in the file.
    std::map<std::string, std::string> full_names(int index, const std::string& part, const Imf::Header& header) const {
        std::map<std::string, std::string> names;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
            if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
                cannot_read(path_, fmt::format("channel '{}' is subsampled (luminance and chroma); store it as RGB",
                                               channel.name()));
            }
            const std::string name = channel.name();
            const bool has_layer = name.find('.') != std::string::npos;
            names.emplace(index == 0 || has_layer ? name : fmt::format("{}.{}", part, name), name);
        }
        return names;
    }

    const std::filesystem::path& path_;
    Imf::MultiPartInputFile& file_;
    std::optional<Frame> frame_;
    Window seen_{};
};

}  // namespace

void write_exr(const std::filesystem::path& path, const Frame& frame) {
    const auto planes = frame.plane_names();
    if (frame.width() < 1 || frame.height() < 1 || planes.empty()) {
        throw ImageError(
            fmt::format("cannot write '{}': the frame is {}x{} with {} planes; an image file needs at least "
                        "one pixel and one plane",
                        path.string(), frame.width(), frame.height(), planes.size()));
    }
    use_all_exr_threads();
    Imf::Header header = make_header(path, frame);
    Imf::FrameBuffer buffer;
    for (const auto& name : planes) add_plane(path, name, frame.plane(name), header, buffer);

    write_exr_atomically(path, [&](Imf::OStream& stream) {
        Imf::OutputFile output(stream, header, writing_threads(frame));
        output.setFrameBuffer(buffer);
        output.writePixels(frame.height());
    });
}

Frame read_exr(const std::filesystem::path& path) {
    check_file(path);
    use_all_exr_threads();
    try {
        Imf::MultiPartInputFile file(path.c_str());
        return Reader(path, file).read();
    } catch (const ImageError&) {
        throw;
    } catch (const std::bad_alloc&) {
        cannot_read(path, "it does not fit into memory");
    } catch (const std::exception& error) {
        cannot_read(path, fmt::format("truncated or damaged ({}); write it again", error.what()));
    }
}

}  // namespace plumb
