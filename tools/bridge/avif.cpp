// AVIF, by libavif and the AV1 encoder of libaom, in one thread: a server makes as many pictures at a time as it has.
#include "bridge.hpp"
#include "encode.hpp"

#include <cmath>

#include <avif/avif.h>

namespace bridge
{
namespace
{

// Of libavif 0.11 and 1.0 alike: speed 8 of 10 takes a third of the time of 6, for files a few hundredths larger.
constexpr int speed = 8, full_color_quality = 90;

// The quantizer of AV1, 0 to 63, with which luma has about the error of a JPEG of that quality.
int quantizer(int quality)
{
    static const struct {
        int quality, quantizer;
    } points[] = {{100, 0}, {90, 16}, {80, 26}, {0, 54}}; // measured from 60 on
    const auto *below = points + 1;
    while (quality < below->quality)
        below++;
    const auto &above = below[-1];
    return int(std::lround(above.quantizer + double(above.quality - quality) * (below->quantizer - above.quantizer) /
                                                 (above.quality - below->quality)));
}

using Image = std::unique_ptr<avifImage, decltype(&avifImageDestroy)>;
using Writer = std::unique_ptr<avifEncoder, decltype(&avifEncoderDestroy)>;

void check(avifResult result)
{
    if (result != AVIF_RESULT_OK)
        throw Failure(result == AVIF_RESULT_OUT_OF_MEMORY ? RETEX_ENOMEM : RETEX_EIO,
                      std::string("cannot write: ") + avifResultToString(result));
}

// The planes of a picture, which as in JPEG have full colour from a quality on.
Image make_planes(const EncodedPicture &picture)
{
    Image image(avifImageCreate(uint32_t(picture.width), uint32_t(picture.height), 8,
                                picture.quality >= full_color_quality ? AVIF_PIXEL_FORMAT_YUV444
                                                                      : AVIF_PIXEL_FORMAT_YUV420),
                avifImageDestroy);
    if (!image)
        throw Failure(RETEX_ENOMEM, "not enough memory for an AVIF");
    image->colorPrimaries = picture.is_srgb ? AVIF_COLOR_PRIMARIES_BT709 : AVIF_COLOR_PRIMARIES_UNSPECIFIED;
    image->transferCharacteristics =
        picture.is_srgb ? AVIF_TRANSFER_CHARACTERISTICS_SRGB : AVIF_TRANSFER_CHARACTERISTICS_UNSPECIFIED;
    image->matrixCoefficients = AVIF_MATRIX_COEFFICIENTS_BT601;
    image->yuvRange = AVIF_RANGE_FULL;
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, image.get());
    rgb.depth = 8;
    rgb.format = picture.channels == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB;
    rgb.pixels = static_cast<uint8_t *>(const_cast<void *>(picture.samples)); // which are only read
    rgb.rowBytes = uint32_t(picture.width) * uint32_t(picture.channels);
    check(avifImageRGBToYUV(image.get(), &rgb));
    return image;
}

} // namespace

void encode_avif(const EncodedPicture &picture, const Sink &sink)
{
    const Image image = make_planes(picture);
    const Writer writer(avifEncoderCreate(), avifEncoderDestroy);
    avifRWData data = AVIF_DATA_EMPTY;
    if (!writer)
        throw Failure(RETEX_ENOMEM, "not enough memory for an AVIF");
    writer->codecChoice = AVIF_CODEC_CHOICE_AOM;
    writer->maxThreads = 1;
    writer->speed = speed;
    writer->minQuantizer = writer->maxQuantizer = quantizer(picture.quality);
    writer->minQuantizerAlpha = writer->maxQuantizerAlpha = AVIF_QUANTIZER_LOSSLESS;
    const avifResult result = avifEncoderWrite(writer.get(), image.get(), &data);
    const std::unique_ptr<avifRWData, decltype(&avifRWDataFree)> free_later(&data, avifRWDataFree);
    check(result);
    sink(data.data, data.size);
}

} // namespace bridge
