/* hash.h: 128 bits that tell contents apart. Quick, not against people who look for two contents of one hash. */
#ifndef TC_CORE_HASH_H
#define TC_CORE_HASH_H

#include "core/status.h"

typedef struct tc_hash {
    uint64_t word[2];
} tc_hash;

/* Of n bytes (NULL allowed for none). Cost: some GB/s on one core. */
tc_hash tc_hash_bytes(const void *data, size_t n, uint64_t seed);

/* Of a large array, in blocks on all threads (0: all cores). Not equal to tc_hash_bytes, but to tc_hash_file of a file
 * that holds these bytes. Errors: TC_E_MEMORY. */
tc_status tc_hash_array(tc_hash *out, const void *data, size_t n, int threads, tc_error *err);

/* Of n bytes of a descriptor from offset on; into [n] keeps them, unless NULL. name is for the sentence. Errors:
 * TC_E_FILE (it cannot be read, or ends before), TC_E_MEMORY. */
tc_status tc_hash_read(tc_hash *out, void *into, int fd, uint64_t offset, size_t n, int threads, const char *name,
                       tc_error *err);

/* Of a whole file; *bytes gets its size. Errors: as tc_hash_read. */
tc_status tc_hash_file(tc_hash *out, uint64_t *bytes, const char *path, int threads, tc_error *err);

#endif
