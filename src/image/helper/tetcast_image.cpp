/* tetcast_image.cpp: the helper program tetcast-image: encodes (all but PNG) and decodes images with OpenImageIO.
 * It opens no file of the user: encoded bytes go to the library, which writes them, and come from it. OpenImageIO works
 * on a file without a name by way of /proc/self/fd. */
#include "core/serve.h"
#include "core/wire.h"
#include "image/helper/png_text.h"
#include "image/helper/tiff_text.h"
#include "image/image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace
{

constexpr size_t JPEG_TEXT_MAX = 60000; /* a JPEG marker holds 65533 bytes */
const char *const EXR_PREFIX = "tetcast:";

/* A file without a name, and its path. */
struct nameless {
    int fd = tc_wire_file();
    nameless()
    {
        if (fd < 0)
            throw std::runtime_error(std::string("no shared memory: ") + std::strerror(errno));
    }
    nameless(const nameless &) = delete;
    nameless &operator=(const nameless &) = delete;
    ~nameless() { close(fd); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(fd); }
};

struct json_owner {
    json_t *json;
    explicit json_owner(json_t *j) : json(j)
    {
        if (!j)
            throw std::bad_alloc();
    }
    json_owner(const json_owner &) = delete;
    json_owner &operator=(const json_owner &) = delete;
    ~json_owner() { json_decref(json); }
};

/* Takes out every /proc/self/fd/N, with the space, parenthesis and quotes around it. */
void drop_own_path(std::string &text)
{
    static const std::string own = "/proc/self/fd/";
    for (size_t at = text.find(own); at != std::string::npos; at = text.find(own, at)) {
        size_t end = at + own.size();
        while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
            end++;
        for (const char *mark = "\")"; *mark; mark++)
            if (end < text.size() && text[end] == *mark)
                end++;
        for (const char *mark = "\"( "; *mark; mark++)
            if (at > 0 && text[at - 1] == *mark)
                at--;
        text.erase(at, end - at);
    }
}

/* One line of OpenImageIO's report, without the path by which it knows the file. */
std::runtime_error failure(std::string text)
{
    drop_own_path(text);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
        text.pop_back();
    for (char &c : text)
        if (c == '\n')
            c = ' ';
    return std::runtime_error(text.empty() ? "OpenImageIO gives no reason" : text);
}

int get_int(json_t *request, const char *key)
{
    return static_cast<int>(json_integer_value(json_object_get(request, key)));
}

text_pairs get_pairs(json_t *request)
{
    text_pairs pairs;
    json_t *list = json_object_get(request, "meta");
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *key = json_string_value(json_array_get(json_array_get(list, i), 0));
        const char *value = json_string_value(json_array_get(json_array_get(list, i), 1));
        if (key && value)
            pairs.emplace_back(key, value);
    }
    return pairs;
}

/* ------------------------------------------------------------------------------------------------------ encoding */

struct picture {
    int width, height, channels;
    TypeDesc type;
    std::vector<uint8_t> bytes;
};

/* Pixels over white as bytes. */
void quantise(picture &out, const float *rgba)
{
    size_t pixels = size_t(out.width) * size_t(out.height);
    out.bytes.resize(pixels * 3);
    uint8_t *to = out.bytes.data();
    for (size_t i = 0; i < pixels; i++, rgba += 4) {
        float alpha = std::fmin(std::fmax(rgba[3], 0.0f), 1.0f);
        for (int c = 0; c < 3; c++)
            *to++ = static_cast<uint8_t>(std::fmin(std::fmax(rgba[c] + (1 - alpha), 0.0f), 1.0f) * 255 + 0.5f);
    }
}

std::string pairs_as_json(const text_pairs &pairs)
{
    json_owner object(json_object());
    for (const auto &[key, value] : pairs)
        json_object_set_new(object.json, key.c_str(), json_string(value.c_str()));
    std::unique_ptr<char, void (*)(void *)> text(json_dumps(object.json, JSON_COMPACT), free);
    if (!text)
        throw std::bad_alloc();
    return text.get();
}

/* The settings of each format. */
ImageSpec make_spec(const std::string &format, const picture &p, int bits, int quality, const text_pairs &pairs,
                    tc_serve *serve)
{
    ImageSpec spec(p.width, p.height, p.channels, p.type);
    if (format == "openexr") {
        spec.set_format(bits == 16 ? TypeDesc::HALF : TypeDesc::FLOAT);
        spec.attribute("compression", "zip");
        for (const auto &[key, value] : pairs)
            spec.attribute((key.rfind(EXR_PREFIX, 0) == 0 ? "" : EXR_PREFIX) + key, value);
    } else {
        std::string text = pairs.empty() ? "" : pairs_as_json(pairs);
        if (format == "jpeg") {
            spec.attribute("Compression", "jpeg:" + std::to_string(quality));
            spec.attribute("CompressionQuality", quality);
            spec.attribute("jpeg:subsampling", "4:4:4");
            spec.attribute("oiio:ColorSpace", "sRGB");
            if (text.size() > JPEG_TEXT_MAX) {
                tc_serve_say(serve, TC_WARNING, "the texts are too long for a JPEG file and are left out");
                text.clear();
            }
        } else {
            spec.attribute("compression", "zip");
        }
        if (!text.empty())
            spec.attribute("ImageDescription", text);
    }
    return spec;
}

bool on_progress(void *context, float fraction)
{
    tc_serve_progress(static_cast<tc_serve *>(context), "writing image", fraction);
    return false;
}

/* Gives the encoded file as one array. */
void send_file(tc_serve *serve, const nameless &file)
{
    struct stat info;
    if (fstat(file.fd, &info) != 0 || info.st_size < 1)
        throw std::runtime_error("OpenImageIO wrote nothing");
    size_t n = static_cast<size_t>(info.st_size);
    void *map = mmap(nullptr, n, PROT_READ, MAP_PRIVATE, file.fd, 0);
    if (map == MAP_FAILED)
        throw std::bad_alloc();
    std::unique_ptr<void, std::function<void(void *)>> owner(map, [n](void *p) { munmap(p, n); });
    json_owner result(json_object());
    tc_array array = {"file", TC_U8, n, map};
    tc_serve_result(serve, result.json, &array, 1);
}

void encode(tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    picture p = {get_int(request, "width"), get_int(request, "height"), 4, TypeDesc::FLOAT, {}};
    int bits = get_int(request, "bits");
    const char *name = json_string_value(json_object_get(request, "format"));
    if (!name || p.width < 1 || p.height < 1 || n_array != 1 || array->type != TC_F32 ||
        array->count != 4 * size_t(p.width) * size_t(p.height))
        throw std::runtime_error("the request to encode is broken");
    const std::string format = name;
    const float *rgba = static_cast<const float *>(array->data);
    const void *pixels = rgba;
    text_pairs pairs = get_pairs(request);
    tc_serve_progress(serve, "writing image", 0);
    if (format == "jpeg") {
        p.channels = 3;
        p.type = TypeDesc::UINT8;
        quantise(p, rgba);
        pixels = p.bytes.data();
    }

    nameless file;
    std::unique_ptr<ImageOutput> out = ImageOutput::create(format);
    if (!out)
        throw failure(OIIO::geterror());
    ImageSpec spec = make_spec(format, p, bits, get_int(request, "quality"), pairs, serve);
    if (!out->open(file.path(), spec) ||
        !out->write_image(p.type, pixels, OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride, on_progress, serve) ||
        !out->close())
        throw failure(out->geterror());
    send_file(serve, file);
}

/* ------------------------------------------------------------------------------------------------------ decoding */

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

/* Puts the file's data window into the whole picture, as premultiplied RGBA. */
std::vector<float> place(const std::vector<float> &data, const ImageSpec &spec, int width, int height)
{
    std::vector<float> rgba(size_t(width) * size_t(height) * 4, 0.0f);
    int channel[4];
    bool premultiply = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    find_channels(channel, spec);
    for (int row = 0; row < spec.height; row++) {
        int y = row + spec.y - spec.full_y;
        for (int column = 0; column < spec.width && y >= 0 && y < height; column++) {
            int x = column + spec.x - spec.full_x;
            if (x < 0 || x >= width)
                continue;
            const float *from = &data[(size_t(row) * size_t(spec.width) + size_t(column)) * size_t(spec.nchannels)];
            float *to = &rgba[(size_t(y) * size_t(width) + size_t(x)) * 4];
            to[3] = channel[3] >= 0 ? from[channel[3]] : 1;
            for (int c = 0; c < 3; c++)
                to[c] = premultiply ? from[channel[c]] * to[3] : from[channel[c]];
        }
    }
    return rgba;
}

/* One tile after the other into data; false on failure. */
bool read_tiles(std::vector<float> &data, ImageInput &in, const ImageSpec &spec)
{
    if (spec.tile_width < 1 || spec.tile_height < 1 ||
        int64_t(spec.tile_width) * spec.tile_height > TC_IMAGE_MAX_PIXELS)
        throw std::runtime_error("its tiles are larger than can be read");
    size_t channels = size_t(spec.nchannels), width = size_t(spec.width), across = size_t(spec.tile_width);
    std::vector<float> tile(across * size_t(spec.tile_height) * channels);
    for (int y = 0; y < spec.height; y += spec.tile_height)
        for (int x = 0; x < spec.width; x += spec.tile_width) {
            if (!in.read_tile(spec.x + x, spec.y + y, spec.z, TypeDesc::FLOAT, tile.data()))
                return false;
            size_t columns = std::min(across, width - size_t(x));
            for (int row = 0; row < std::min(spec.tile_height, spec.height - y); row++)
                std::copy_n(&tile[size_t(row) * across * channels], columns * channels,
                            &data[(size_t(y + row) * width + size_t(x)) * channels]);
        }
    return true;
}

/* TIFF in pieces: OpenImageIO 2.4's read_image gives zeros and no error where such a file is cut off. */
void read_pixels(std::vector<float> &data, ImageInput &in, const ImageSpec &spec, const std::string &format)
{
    bool good = true;
    if (format != "tiff")
        good = in.read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, data.data());
    else if (spec.tile_width != 0)
        good = read_tiles(data, in, spec);
    else
        for (int row = 0; row < spec.height && good; row++)
            good = in.read_scanline(spec.y + row, spec.z, TypeDesc::FLOAT,
                                    &data[size_t(row) * size_t(spec.width) * size_t(spec.nchannels)]);
    std::string report = in.geterror();
    if (!good ||
        report.find("Premature end") != std::string::npos) /* libjpeg calls that a warning and fills with grey */
        throw failure(report);
}

void decode(tc_serve *serve, const tc_array *array, size_t n_array)
{
    if (n_array != 1 || array->type != TC_U8)
        throw std::runtime_error("the request to decode is broken");
    const uint8_t *bytes = static_cast<const uint8_t *>(array->data);
    const std::string format = format_of(bytes, array->count);
    nameless file;
    for (size_t at = 0; at < array->count;) {
        ssize_t n = write(file.fd, bytes + at, array->count - at);
        if (n <= 0 && errno != EINTR)
            throw std::runtime_error(std::string("no shared memory: ") + std::strerror(errno));
        at += n > 0 ? size_t(n) : 0;
    }
    std::unique_ptr<ImageInput> in = ImageInput::create(format);
    ImageSpec spec, config;
    config.attribute("oiio:UnassociatedAlpha", 1); /* premultiplied here in float, not by the reader in 8 bit */
    if (!in)
        throw failure(OIIO::geterror());
    if (!in->open(file.path(), spec, config))
        throw failure(in->geterror());
    int width = spec.full_width > 0 ? spec.full_width : spec.width;
    int height = spec.full_height > 0 ? spec.full_height : spec.height;
    if (int64_t(width) * height > TC_IMAGE_MAX_PIXELS || int64_t(spec.width) * spec.height > TC_IMAGE_MAX_PIXELS ||
        spec.nchannels < 1 || spec.nchannels > 64 || spec.depth > 1)
        throw std::runtime_error("its " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                                 " pixels of " + std::to_string(spec.nchannels) +
                                 " channels are more than can be read");
    tc_serve_progress(serve, "reading image", -1);
    std::vector<float> data(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
    read_pixels(data, *in, spec, format);
    std::vector<float> rgba = place(data, spec, width, height);

    json_owner result(
        json_pack("{s:i,s:i,s:s,s:[]}", "width", width, "height", height, "format", format.c_str(), "meta"));
    for (const auto &[key, value] : texts_of(format, spec, bytes, array->count)) {
        json_t *pair = json_array();
        json_array_append_new(pair, tc_wire_string(key.c_str()));
        json_array_append_new(pair, tc_wire_string(value.c_str()));
        json_array_append_new(json_object_get(result.json, "meta"), pair);
    }
    tc_array pixels = {"rgba", TC_F32, rgba.size(), rgba.data()};
    tc_serve_result(serve, result.json, &pixels, 1);
}

void handle(void *, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    const char *what = json_string_value(json_object_get(request, "do"));
    try {
        if (what && std::strcmp(what, "encode") == 0)
            encode(serve, request, array, n_array);
        else if (what && std::strcmp(what, "decode") == 0)
            decode(serve, array, n_array);
        else
            tc_serve_error(serve, "tetcast-image can only encode and decode");
    } catch (const std::bad_alloc &) {
        tc_serve_error(serve, "memory ran out for this image");
    } catch (const std::exception &e) {
        tc_serve_error(serve, e.what());
    } catch (...) {
        tc_serve_error(serve, "an unknown failure in OpenImageIO");
    }
}

} // namespace

int main(int argc, char **argv)
{
    return tc_serve_main(argc, argv, "tetcast-image", handle, nullptr);
}
