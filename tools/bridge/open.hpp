// An open picture file with a picture of an acceptable size.
#ifndef RETEX_BRIDGE_OPEN_HPP
#define RETEX_BRIDGE_OPEN_HPP

#include "bridge.hpp"

#include <algorithm>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace bridge
{

// Throw Failure if the picture has no pixels, or too many.
void check_size(long width, long height, const RetexBridgeFile &file);

// With a format, only that format's decoder gets the file, as an open file without a name.
class OpenPicture
{
  public:
    OpenPicture(const RetexBridgeHost *host, const RetexBridgeFile &file);
    OIIO::ImageInput *operator->() const
    {
        return in_.get();
    }
    OIIO::ImageInput &operator*() const
    {
        return *in_;
    }
    const Chunks &chunks() const // of a PNG, that say something of its colours
    {
        return chunks_;
    }
    // To be called before the pixels are read: looks for damage that OpenImageIO would not tell.
    void check_pixels();
    // To be called after pixels were read, or not.
    void check_read(bool is_read);
    // Make the pixels that are not in the file zero: values of `channels` a pixel, of the rows from y0 on to y1.
    template <typename Value> void blank_lost(Value *values, int y0, int y1, int channels) const
    {
        const long width = in_->spec().width;
        for (const Area &area : lost_) {
            const long x0 = std::min<long>(area.x, width), x1 = std::min<long>(x0 + area.width, width);
            for (long y = std::max<long>(area.y, y0); y < std::min<long>(long(area.y) + area.height, y1); y++)
                std::fill_n(values + ((y - y0) * width + x0) * channels, (x1 - x0) * channels, Value(0));
        }
    }
    // What is damaged in a file that is read all the same, or "".
    const std::string &damage() const
    {
        return damage_;
    }

  private:
    void open_as(const char *format, const OIIO::ImageSpec &wish);
    void check_decoder(const OIIO::ImageSpec &wish);
    void note(const std::string &damage);

    const RetexBridgeHost *host_;
    const RetexBridgeFile &file_;
    Chunks chunks_;
    std::string damage_;
    std::vector<Area> lost_;
    Stream stream_{nullptr, std::fclose};
    std::unique_ptr<OIIO::Filesystem::IOFile> proxy_;
    std::unique_ptr<OIIO::ImageInput> in_; // last member: destroyed first
};

} // namespace bridge
#endif
