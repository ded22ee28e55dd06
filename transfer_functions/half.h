/* half.h: IEEE half floats. */
#ifndef TC_TRANSFER_FUNCTIONS_HALF_H
#define TC_TRANSFER_FUNCTIONS_HALF_H

#include <stdint.h>
#include <string.h>

/* Nearest half of v, |v| <= 65504. Below the normal halves, adding 0.5 rounds to their spacing. */
static inline uint16_t tc_half_of(float v)
{
    uint32_t bits, small_bits;
    memcpy(&bits, &v, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000;
    bits &= 0x7fffffff;
    float magnitude;
    memcpy(&magnitude, &bits, sizeof bits);
    const float small = magnitude + 0.5f;
    memcpy(&small_bits, &small, sizeof small_bits);
    const uint32_t normal = (bits - (UINT32_C(112) << 23) + 0xfff + ((bits >> 13) & 1)) >> 13;
    const uint32_t tiny = small_bits - (UINT32_C(126) << 23);
    return (uint16_t)(sign | (bits < (UINT32_C(113) << 23) ? tiny : normal));
}

#endif
