/* decode.cpp: pictures of PNG, EXR, TIFF and JPEG files, with OpenImageIO. */
#include "image/helper/decode.h"
#include "core/wire.h"
#include "image/helper/common.h"
#include "image/helper/png_text.h"
#include "image/helper/tiff_text.h"
#include "image/image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <functional>
#include <memory>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using OIIO::ImageInput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace
{

constexpr size_t PIECE_ROWS = 64, PIECE_MAX = size_t(1) << 28; /* floats */

std::string format_of(const uint8_t *p, size_t n)
{
    static const struct {
        const char *format, *magic;
        size_t n;
    } known[] = {{"png", "\x89PNG\r\n\x1a\n", 8},
                 {"openexr", "\x76\x2f\x31\x01", 4},
                 {"tiff", "II*\0", 4},
                 {"tiff", "MM\0*", 4},
                 {"tiff", "II+\0", 4},
                 {"tiff", "MM\0+", 4},
                 {"jpeg", "\xff\xd8\xff", 3}};
    for (const auto &k : known)
        if (n >= k.n && std::memcmp(p, k.magic, k.n) == 0)
            return k.format;
    throw std::runtime_error("it is no PNG, EXR, TIFF or JPEG image");
}

/* The texts this program's own files carry; of PNG, all there are. */
text_pairs texts_of(const std::string &format, const ImageSpec &spec, const uint8_t *data, size_t n)
{
    text_pairs pairs;
    if (format == "png")
        return png_text_read(data, n);
    if (format == "openexr") {
        for (const auto &attribute : spec.extra_attribs) {
            std::string key = attribute.name().string();
            if (attribute.type() == TypeDesc::STRING && key.rfind(EXR_PREFIX, 0) == 0)
                pairs.emplace_back(key.substr(std::strlen(EXR_PREFIX)), attribute.get_string());
        }
        return pairs;
    }
    std::string text =
        format == "tiff" ? tiff_description_read(data, n) : std::string(spec.get_string_attribute("ImageDescription"));
    json_t *object = text.empty() ? nullptr : json_loads(text.c_str(), 0, nullptr);
    if (json_is_object(object)) {
        const char *key;
        json_t *value;
        json_object_foreach(object, key, value) if (json_is_string(value))
            pairs.emplace_back(key, json_string_value(value));
    } else if (!text.empty()) {
        pairs.emplace_back("ImageDescription", text);
    }
    json_decref(object);
    return pairs;
}

/* Which channels of the file are red, green, blue and alpha; -1: alpha is 1. */
void find_channels(int *out, const ImageSpec &spec)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    int colours = spec.nchannels - (spec.alpha_channel >= 0);
    for (int c = 0; c < 4; c++)
        out[c] = spec.channelindex(names[c]);
    if (out[0] < 0 || out[1] < 0 || out[2] < 0)
        for (int c = 0; c < 3; c++)
            out[c] = colours >= 3 ? c : 0;
    if (out[3] < 0)
        out[3] = spec.alpha_channel;
}

/* Puts the file's data window into the whole picture, as premultiplied RGBA; *depth gets channel Z, where it is wanted.
 */
std::vector<float> place(std::vector<float> *depth, const std::vector<float> &data, const ImageSpec &spec, int width,
                         int height)
{
    std::vector<float> rgba(size_t(width) * size_t(height) * 4, 0.0f);
    int channel[4];
    bool premultiply = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    find_channels(channel, spec);
    const int z = depth ? spec.channelindex("Z") : -1;
    if (z >= 0)
        depth->assign(size_t(width) * size_t(height), 0.0f);
    for (int row = 0; row < spec.height; row++) {
        int y = row + spec.y - spec.full_y;
        for (int column = 0; column < spec.width && y >= 0 && y < height; column++) {
            int x = column + spec.x - spec.full_x;
            if (x < 0 || x >= width)
                continue;
            const float *from = &data[(size_t(row) * size_t(spec.width) + size_t(column)) * size_t(spec.nchannels)];
            float *to = &rgba[(size_t(y) * size_t(width) + size_t(x)) * 4];
            if (z >= 0)
                (*depth)[size_t(y) * size_t(width) + size_t(x)] = from[z];
            to[3] = channel[3] >= 0 ? from[channel[3]] : 1;
            for (int c = 0; c < 3; c++)
                to[c] = premultiply ? from[channel[c]] * to[3] : from[channel[c]];
        }
    }
    return rgba;
}

/* What is read of a file: its rows and columns, of the data window, as floats of all channels; across: columns from one
 * row to the next. */
using piece_taker = std::function<void(const float *piece, int x, int y, int columns, int rows, size_t across)>;

void check_report(ImageInput &in, bool good)
{
    std::string report = in.geterror();
    if (!good ||
        report.find("Premature end") != std::string::npos) /* libjpeg calls that a warning and fills with grey */
        throw failure(report);
}

void read_tiles(ImageInput &in, const ImageSpec &spec, const piece_taker &take)
{
    if (spec.tile_width < 1 || spec.tile_height < 1 ||
        size_t(spec.tile_width) * size_t(spec.tile_height) > PIECE_MAX / size_t(spec.nchannels))
        throw std::runtime_error("its tiles are larger than can be read");
    std::vector<float> tile(size_t(spec.tile_width) * size_t(spec.tile_height) * size_t(spec.nchannels));
    for (int y = 0; y < spec.height; y += spec.tile_height)
        for (int x = 0; x < spec.width; x += spec.tile_width) {
            check_report(in, in.read_tile(spec.x + x, spec.y + y, spec.z, TypeDesc::FLOAT, tile.data()));
            take(tile.data(), x, y, std::min(spec.tile_width, spec.width - x),
                 std::min(spec.tile_height, spec.height - y), size_t(spec.tile_width));
        }
}

/* In pieces: OpenImageIO 2.4's read_image gives zeros and no error where a TIFF file is cut off, and so do many of its
 * rows at once. */
void read_pieces(ImageInput &in, const ImageSpec &spec, const std::string &format, const piece_taker &take)
{
    if (spec.tile_width != 0) {
        read_tiles(in, spec, take);
        return;
    }
    const size_t row = size_t(spec.width) * size_t(spec.nchannels);
    if (row > PIECE_MAX)
        throw std::runtime_error("its rows are longer than can be read");
    const int rows = format == "tiff" ? 1 : int(std::max(size_t(1), std::min(PIECE_ROWS, PIECE_MAX / row)));
    std::vector<float> piece(row * size_t(rows));
    for (int y = 0; y < spec.height; y += rows) {
        const int n = std::min(rows, spec.height - y);
        check_report(in, n == 1 ? in.read_scanline(spec.y + y, spec.z, TypeDesc::FLOAT, piece.data())
                                : in.read_scanlines(0, 0, spec.y + y, spec.y + y + n, spec.z, 0, spec.nchannels,
                                                    TypeDesc::FLOAT, piece.data()));
        take(piece.data(), 0, y, spec.width, n, size_t(spec.width));
    }
}

std::unique_ptr<ImageInput> open_input(ImageSpec &spec, const std::string &path, const std::string &format,
                                       int64_t most)
{
    std::unique_ptr<ImageInput> in = ImageInput::create(format);
    ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); /* premultiplied here in float, not by the reader in 8 bit */
    if (!in)
        throw failure(OIIO::geterror());
    if (!in->open(path, spec, config))
        throw failure(in->geterror());
    const int width = std::max(spec.full_width, spec.width), height = std::max(spec.full_height, spec.height);
    if (int64_t(width) * height > most || spec.width < 1 || spec.height < 1 || spec.nchannels < 1 ||
        spec.nchannels > 64 || spec.depth > 1)
        throw std::runtime_error("its " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                                 " pixels of " + std::to_string(spec.nchannels) +
                                 " channels are more than can be read");
    return in;
}

json_t *texts_as_json(const text_pairs &texts)
{
    json_t *list = json_array();
    for (const auto &[key, value] : texts) {
        json_t *pair = json_array();
        json_array_append_new(pair, tc_wire_string(key.c_str()));
        json_array_append_new(pair, tc_wire_string(value.c_str()));
        json_array_append_new(list, pair);
    }
    return list;
}

/* The whole file in memory, as far as it is looked at. */
struct mapping {
    size_t n = 0;
    void *data = nullptr;
    explicit mapping(int fd)
    {
        struct stat info;
        if (fstat(fd, &info) != 0 || info.st_size < 1)
            throw std::runtime_error("it is empty");
        n = static_cast<size_t>(info.st_size);
        data = mmap(nullptr, n, PROT_READ, MAP_PRIVATE, fd, 0);
        if (data == MAP_FAILED)
            throw std::bad_alloc();
    }
    mapping(const mapping &) = delete;
    mapping &operator=(const mapping &) = delete;
    ~mapping() { munmap(data, n); }
};

} // namespace

void decode(tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    if (n_array != 1 || array->type != TC_U8)
        throw std::runtime_error("the request to decode is broken");
    const uint8_t *bytes = static_cast<const uint8_t *>(array->data);
    const std::string format = format_of(bytes, array->count);
    open_file file;
    for (size_t at = 0; at < array->count;) {
        ssize_t n = write(file.fd, bytes + at, array->count - at);
        if (n <= 0 && errno != EINTR)
            throw std::runtime_error(std::string("no shared memory: ") + std::strerror(errno));
        at += n > 0 ? size_t(n) : 0;
    }
    ImageSpec spec;
    std::unique_ptr<ImageInput> in = open_input(spec, file.path(), format, TC_IMAGE_MAX_READ);
    const int width = spec.full_width > 0 ? spec.full_width : spec.width;
    const int height = spec.full_height > 0 ? spec.full_height : spec.height;
    const size_t channels = size_t(spec.nchannels);
    tc_serve_progress(serve, "reading image", -1);
    std::vector<float> data(size_t(spec.width) * size_t(spec.height) * channels), depth;
    read_pieces(*in, spec, format, [&](const float *piece, int x, int y, int columns, int rows, size_t across) {
        for (int row = 0; row < rows; row++)
            std::copy_n(piece + size_t(row) * across * channels, size_t(columns) * channels,
                        &data[(size_t(y + row) * size_t(spec.width) + size_t(x)) * channels]);
    });
    const bool wanted = json_is_true(json_object_get(request, "depth"));
    std::vector<float> rgba = place(wanted ? &depth : nullptr, data, spec, width, height);

    json_owner result(json_pack("{s:i,s:i,s:s,s:o}", "width", width, "height", height, "format", format.c_str(), "meta",
                                texts_as_json(texts_of(format, spec, bytes, array->count))));
    const tc_array pixels[2] = {{"rgba", TC_F32, rgba.size(), rgba.data()},
                                {"depth", TC_F32, depth.size(), depth.data()}};
    tc_serve_result(serve, result.json, pixels, depth.empty() ? 1 : 2);
}

void check(tc_serve *serve, json_t *request)
{
    const char *path = json_string_value(json_object_get(request, "file"));
    if (!path)
        throw std::runtime_error("the request to check is broken");
    open_file file(path, O_RDONLY);
    mapping map(file.fd);
    const uint8_t *bytes = static_cast<const uint8_t *>(map.data);
    const std::string format = format_of(bytes, map.n);
    ImageSpec spec;
    std::unique_ptr<ImageInput> in = open_input(spec, file.path(), format, TC_IMAGE_MAX_PIXELS);
    read_pieces(*in, spec, format, [&](const float *, int, int y, int, int, size_t) {
        tc_serve_progress(serve, "reading image", double(y) / spec.height);
    });
    json_owner result(json_pack("{s:o}", "meta", texts_as_json(texts_of(format, spec, bytes, map.n))));
    tc_serve_result(serve, result.json, nullptr, 0);
}
