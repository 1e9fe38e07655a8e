// Checks that a JPEG or PNG file is whole, before its decoder reads it. libjpeg silently replaces missing data by grey,
// and libpng prints to standard error. A JPEG's markers are checked up to the end marker, a PNG's chunks with
// checksums.
#include "bridge.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fcntl.h>
#include <unistd.h>

namespace bridge
{
namespace
{

// Reads bytes in order; -1 after the end.
class Reader
{
  public:
    explicit Reader(const RetexBridgeFile &file) : file_(open_file(file))
    {
    }
    int byte()
    {
        return getc_unlocked(file_.get());
    }
    // A big-endian number; -1 if the file ends before it.
    int64_t number(int bytes)
    {
        int64_t value = 0;
        for (int i = 0; i < bytes; i++) {
            int next = byte();
            if (next < 0)
                return -1;
            value = value << 8 | next;
        }
        return value;
    }
    bool skip(int64_t bytes)
    {
        while (bytes-- > 0)
            if (byte() < 0)
                return false;
        return true;
    }
    void rewind()
    {
        std::rewind(file_.get());
    }

  private:
    std::unique_ptr<FILE, int (*)(FILE *)> file_;
};

[[noreturn]] void fail_truncated()
{
    throw Failure(RETEX_EFORMAT, "cannot read: the file is truncated");
}

// Check from after the start-of-image marker to the end-of-image marker. Data without markers is left to libjpeg, which
// reports it.
void check_jpeg(Reader &in)
{
    enum { Stuffed = 0x00, Temporary = 0x01, Restart = 0xd0, RestartEnd = 0xd8, End = 0xd9, Scan = 0xda };
    for (bool scan = false;;) {
        int c = in.byte();
        if (c < 0)
            fail_truncated();
        if (c != 0xff && !scan)
            return;
        if (c != 0xff)
            continue;
        while (c == 0xff)
            c = in.byte();
        if (c == End)
            return;
        if (c == Stuffed || c == Temporary || (c >= Restart && c < RestartEnd))
            continue;
        int64_t length = in.number(2);
        if (length < 0 || !in.skip(length - 2))
            fail_truncated();
        scan = c == Scan;
    }
}

uint32_t crc_of(uint32_t crc, int byte)
{
    crc ^= uint32_t(byte);
    for (int bit = 0; bit < 8; bit++)
        crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    return crc;
}

// A table of crc_of for all byte values.
struct CrcTable {
    uint32_t of[256];
    CrcTable()
    {
        for (int i = 0; i < 256; i++)
            of[i] = crc_of(0, i);
    }
};

// Check the chunks from after the signature to IEND.
void check_png(Reader &in)
{
    static const CrcTable table;
    for (;;) {
        int64_t length = in.number(4);
        uint32_t crc = 0xffffffff, type = 0;
        if (length < 0)
            fail_truncated();
        for (int64_t i = 0; i < length + 4; i++) {
            int c = in.byte();
            if (c < 0)
                fail_truncated();
            crc = table.of[(crc ^ uint32_t(c)) & 255] ^ crc >> 8;
            type = i < 4 ? type << 8 | uint32_t(c) : type;
        }
        int64_t stored = in.number(4);
        if (stored < 0)
            fail_truncated();
        if (uint32_t(stored) != ~crc)
            throw Failure(RETEX_EFORMAT, "cannot read: the file is damaged: a checksum is wrong");
        if (type == 0x49454e44) // IEND
            return;
    }
}

} // namespace

std::unique_ptr<FILE, int (*)(FILE *)> open_file(const RetexBridgeFile &file)
{
    const int copy = file.format ? fcntl(file.descriptor, F_DUPFD_CLOEXEC, 3) : -1;
    std::unique_ptr<FILE, int (*)(FILE *)> stream(!file.format ? std::fopen(file.path, "rb")
                                                  : copy < 0   ? nullptr
                                                               : fdopen(copy, "rb"),
                                                  std::fclose);
    if (!stream) {
        const int why = errno;
        if (copy >= 0)
            close(copy);
        throw Failure(RETEX_EIO, std::string("cannot read: ") + std::strerror(why));
    }
    if (file.format)
        std::rewind(stream.get()); // all copies of the descriptor share the file position
    return stream;
}

void check_whole(const RetexBridgeFile &file)
{
    Reader in(file);
    if (in.number(2) == 0xffd8)
        return check_jpeg(in);
    in.rewind();
    if (in.number(8) == int64_t(0x89504e470d0a1a0a))
        check_png(in);
}

} // namespace bridge
