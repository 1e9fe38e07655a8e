// See encode.hpp.
#include "encode.hpp"

#include "endings.hpp"

#include <cstdint>

namespace bridge
{
namespace
{

// Rows go from bottom to top.
void encode_pfm(const EncodedPicture &picture, const Sink &sink)
{
    const uint16_t probe = 1;
    const bool little = *reinterpret_cast<const uint8_t *>(&probe) == 1;
    const std::string header = (picture.channels == 1 ? "Pf\n" : "PF\n") + std::to_string(picture.width) + " " +
                               std::to_string(picture.height) + (little ? "\n-1.0\n" : "\n1.0\n");
    const size_t row = size_t(picture.width) * picture.channels;
    sink(header.data(), header.size());
    for (int y = picture.height; y-- > 0;)
        sink(static_cast<const float *>(picture.samples) + y * row, row * sizeof(float));
}

} // namespace

const Encoder *find_encoder(const std::string &ending)
{
    static const Encoder encoders[] = {
        {"pfm", false, encode_pfm}, {"avif", true, encode_avif}, {"jxl", true, encode_jxl}};
    for (const Encoder &one : encoders)
        if (lower(ending) == one.format)
            return &one;
    return nullptr;
}

} // namespace bridge
