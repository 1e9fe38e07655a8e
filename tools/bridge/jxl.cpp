// JPEG XL, by libjxl, in one thread: a server makes as many pictures at a time as it has.
#include "bridge.hpp"
#include "encode.hpp"

#include <jxl/encode.h>

namespace bridge
{
namespace
{

constexpr int effort = 4; // of 9

// As cjxl has it: about the error of a JPEG of that quality. 1 is where eyes begin to see it.
float distance(int quality)
{
    const float q = float(quality);
    return q >= 30 ? .1f + (100 - q) * .09f : 53 / 3000.f * q * q - 23 / 20.f * q + 25;
}

void check(bool is_right)
{
    if (!is_right)
        throw Failure(RETEX_EIO, "cannot write: libjxl refuses the picture");
}

void describe(JxlEncoder *encoder, const EncodedPicture &picture)
{
    JxlBasicInfo info;
    JxlColorEncoding color;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = uint32_t(picture.width);
    info.ysize = uint32_t(picture.height);
    info.bits_per_sample = 8;
    info.num_color_channels = 3;
    info.num_extra_channels = info.alpha_bits = 0;
    if (picture.channels == 4) {
        info.num_extra_channels = 1;
        info.alpha_bits = 8;
    }
    info.uses_original_profile = JXL_FALSE;
    check(JxlEncoderSetBasicInfo(encoder, &info) == JXL_ENC_SUCCESS);
    JxlColorEncodingSetToSRGB(&color, JXL_FALSE); // a file has to say something
    check(JxlEncoderSetColorEncoding(encoder, &color) == JXL_ENC_SUCCESS);
}

void add_pixels(JxlEncoder *encoder, const EncodedPicture &picture)
{
    const JxlPixelFormat format = {uint32_t(picture.channels), JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};
    JxlEncoderFrameSettings *settings = JxlEncoderFrameSettingsCreate(encoder, nullptr);
    check(settings && JxlEncoderSetFrameDistance(settings, distance(picture.quality)) == JXL_ENC_SUCCESS &&
          JxlEncoderFrameSettingsSetOption(settings, JXL_ENC_FRAME_SETTING_EFFORT, effort) == JXL_ENC_SUCCESS &&
          JxlEncoderAddImageFrame(settings, &format, picture.samples,
                                  size_t(picture.width) * picture.height * picture.channels) == JXL_ENC_SUCCESS);
    JxlEncoderCloseInput(encoder);
}

} // namespace

void encode_jxl(const EncodedPicture &picture, const Sink &sink)
{
    const std::unique_ptr<JxlEncoder, decltype(&JxlEncoderDestroy)> encoder(JxlEncoderCreate(nullptr),
                                                                            JxlEncoderDestroy);
    Bytes buffer(size_t(1) << 16);
    if (!encoder)
        throw Failure(RETEX_ENOMEM, "not enough memory for a JPEG XL");
    describe(encoder.get(), picture);
    add_pixels(encoder.get(), picture);
    for (JxlEncoderStatus status = JXL_ENC_NEED_MORE_OUTPUT; status == JXL_ENC_NEED_MORE_OUTPUT;) {
        uint8_t *next = buffer.data();
        size_t left = buffer.size();
        status = JxlEncoderProcessOutput(encoder.get(), &next, &left);
        check(status != JXL_ENC_ERROR);
        sink(buffer.data(), buffer.size() - left);
    }
}

} // namespace bridge
