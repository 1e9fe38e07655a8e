/* See checksum.h. */
#include "io/checksum.h"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>
#include <zlib.h>

#include "base/cpu.h"

uint32_t retex_crc32(uint32_t so_far, const void *bytes, size_t count)
{
    if (!count)
        return so_far;
    const uint32_t sum = crc32_gzip_refl(so_far, bytes, count);
    retex_cpu_clear_upper_halves();
    return sum;
}

uint32_t retex_crc32_join(uint32_t first, uint32_t second, size_t second_bytes)
{
    return (uint32_t)crc32_combine(first, second, (z_off_t)second_bytes);
}

uint32_t retex_adler32(uint32_t so_far, const void *bytes, size_t count)
{
    if (!count)
        return so_far;
    const uint32_t sum = isal_adler32(so_far, bytes, count);
    retex_cpu_clear_upper_halves();
    return sum;
}
