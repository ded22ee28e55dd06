/* peak.c: peak memory of this process and of its helpers. */
#include "core/wire.h"

void tc_memory_peak(size_t *self_bytes, size_t *helper_bytes)
{
    if (self_bytes)
        *self_bytes = tc_wire_peak_bytes();
    if (helper_bytes)
        *helper_bytes = tc_worker_peak_bytes();
}
