/* encode.cpp: pictures as EXR, TIFF and JPEG files, row by row, with OpenImageIO. */
#include "image/helper/encode.h"
#include "image/helper/common.h"
#include "image/helper/png_text.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <vector>

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace
{

constexpr size_t JPEG_TEXT_MAX = 60000; /* a JPEG marker holds 65533 bytes */
constexpr size_t BUFFER = 1 << 20;

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

/* A stream on a descriptor of its own: its error flag stays set, whoever of the libraries between does not look. */
std::FILE *open_stream(int fd)
{
    int own = fcntl(fd, F_DUPFD_CLOEXEC, 0);
    std::FILE *stream = own >= 0 ? fdopen(own, "w+b") : nullptr;
    if (!stream) {
        if (own >= 0)
            close(own);
        throw std::runtime_error(std::string("tetcast-image cannot open it: ") + std::strerror(errno));
    }
    std::setvbuf(stream, nullptr, _IOFBF, BUFFER);
    return stream;
}

struct stream_closer {
    void operator()(std::FILE *f) const { std::fclose(f); }
};

} // namespace

struct encoder::state {
    int width, height, row = 0;
    bool jpeg, opaque, depth;
    open_file file;
    std::unique_ptr<std::FILE, stream_closer> stream;
    OIIO::Filesystem::IOFile proxy;
    std::unique_ptr<ImageOutput> out; /* goes before proxy and stream, to which it writes */
    std::vector<uint8_t> bytes;
    std::vector<float> floats;

    explicit state(const char *path)
        : file(path, O_RDWR), stream(open_stream(file.fd)), proxy(stream.get(), OIIO::Filesystem::IOProxy::Write)
    {
    }
    const void *levels(const float *rgba, size_t pixels);
    const void *channels(const float *rgba, const float *z, size_t pixels);
};

/* Pixels over white, or as they are where the picture is opaque, as bytes. */
const void *encoder::state::levels(const float *rgba, size_t pixels)
{
    bytes.resize(pixels * 3);
    uint8_t *to = bytes.data();
    for (size_t i = 0; i < pixels; i++, rgba += 4) {
        float alpha = opaque ? 1.0f : std::fmin(std::fmax(rgba[3], 0.0f), 1.0f);
        for (int c = 0; c < 3; c++)
            *to++ = static_cast<uint8_t>(std::fmin(std::fmax(rgba[c] + (1 - alpha), 0.0f), 1.0f) * 255 + 0.5f);
    }
    return bytes.data();
}

/* Pixels with depth beside them, or with an alpha of 1; as they are where they are neither. */
const void *encoder::state::channels(const float *rgba, const float *z, size_t pixels)
{
    if (!z && !opaque)
        return rgba;
    const size_t n = z ? 5 : 4;
    floats.resize(pixels * n);
    float *to = floats.data();
    for (size_t i = 0; i < pixels; i++, rgba += 4, to += n) {
        std::copy_n(rgba, 4, to);
        if (opaque)
            to[3] = 1;
        if (z)
            to[4] = z[i];
    }
    return floats.data();
}

static void set_exr(ImageSpec &spec, bool depth, int bits, const text_pairs &pairs)
{
    const TypeDesc colour = bits == 16 ? TypeDesc::HALF : TypeDesc::FLOAT;
    spec.set_format(colour);
    if (depth) {
        spec.channelnames = {"R", "G", "B", "A", "Z"};
        spec.channelformats = {colour, colour, colour, colour, TypeDesc::FLOAT};
        spec.alpha_channel = 3;
        spec.z_channel = 4;
    }
    spec.attribute("compression", "zip");
    for (const auto &[key, value] : pairs)
        spec.attribute((key.rfind(EXR_PREFIX, 0) == 0 ? "" : EXR_PREFIX) + key, value);
}

static void set_jpeg(ImageSpec &spec, int quality, std::string &text, tc_serve *serve)
{
    spec.attribute("Compression", "jpeg:" + std::to_string(quality));
    spec.attribute("CompressionQuality", quality);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("oiio:ColorSpace", "sRGB");
    if (text.size() > JPEG_TEXT_MAX) {
        tc_serve_say(serve, TC_WARNING, "the texts are too long for a JPEG file and are left out");
        text.clear();
    }
}

/* The settings of each format. TIFF beyond 4 GB is BigTIFF: OpenImageIO sees to it. */
static ImageSpec make_spec(const std::string &format, int width, int height, bool depth, json_t *request,
                           tc_serve *serve)
{
    const bool jpeg = format == "jpeg";
    ImageSpec spec(width, height, jpeg ? 3 : depth ? 5 : 4, jpeg ? TypeDesc::UINT8 : TypeDesc::FLOAT);
    const text_pairs pairs = get_pairs(request);
    if (format == "openexr") {
        set_exr(spec, depth, get_int(request, "bits"), pairs);
        return spec;
    }
    std::string text = pairs.empty() ? "" : pairs_as_json(pairs);
    if (jpeg)
        set_jpeg(spec, get_int(request, "quality"), text, serve);
    else
        spec.attribute("compression", "zip");
    if (!text.empty())
        spec.attribute("ImageDescription", text);
    return spec;
}

encoder::encoder(tc_serve *serve, json_t *request)
{
    const char *path = json_string_value(json_object_get(request, "file"));
    const char *name = json_string_value(json_object_get(request, "format"));
    const int width = get_int(request, "width"), height = get_int(request, "height");
    if (!path || !name || width < 1 || height < 1)
        throw std::runtime_error("the request to begin is broken");
    const std::string format = name;
    s = std::make_unique<state>(path);
    s->width = width;
    s->height = height;
    s->jpeg = format == "jpeg";
    s->opaque = json_is_true(json_object_get(request, "opaque"));
    s->depth = json_is_true(json_object_get(request, "depth")) && format == "openexr";
    s->out = ImageOutput::create(format);
    if (!s->out)
        throw failure(OIIO::geterror());
    ImageSpec spec = make_spec(format, width, height, s->depth, request, serve);
    OIIO::Filesystem::IOProxy *proxy = &s->proxy;
    spec.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
    if (!s->out->open("image." + format, spec))
        throw failure(s->out->geterror());
}

encoder::~encoder() = default;

void encoder::rows(const tc_array *array, size_t n_array)
{
    const size_t width = static_cast<size_t>(s->width);
    if (n_array != (s->depth ? 2 : 1) || array[0].type != TC_F32 || array[0].count == 0 ||
        array[0].count % (4 * width) != 0 || array[0].count / (4 * width) > static_cast<size_t>(s->height - s->row) ||
        (s->depth && (array[1].type != TC_F32 || array[1].count * 4 != array[0].count)))
        throw std::runtime_error("the request to write rows is broken");
    const float *rgba = static_cast<const float *>(array[0].data);
    const float *z = s->depth ? static_cast<const float *>(array[1].data) : nullptr;
    const size_t pixels = array[0].count / 4;
    const int n = static_cast<int>(pixels / width);
    const void *data = s->jpeg ? s->levels(rgba, pixels) : s->channels(rgba, z, pixels);
    if (!s->out->write_scanlines(s->row, s->row + n, 0, s->jpeg ? TypeDesc::UINT8 : TypeDesc::FLOAT, data))
        throw failure(s->out->geterror());
    s->row += n;
    if (std::ferror(s->stream.get()))
        throw std::runtime_error("the file takes no more bytes");
}

void encoder::end()
{
    if (s->row != s->height)
        throw std::runtime_error("rows are missing");
    if (!s->out->close())
        throw failure(s->out->geterror());
    s->out.reset();
    if (std::fflush(s->stream.get()) != 0 || std::ferror(s->stream.get()))
        throw std::runtime_error("the file takes no more bytes");
}
