/* room.h: whether memory will do, before it is taken. */
#ifndef TC_CORE_ROOM_H
#define TC_CORE_ROOM_H

#include "core/status.h"

/* Bytes that this process may still take: the least of what the system and its control groups (versions 1 and 2) have left,
 * with what they can drop of files they hold; or what the environment variable TETCAST_MEMORY says (bytes, or a number with
 * K, M, G or T behind it). SIZE_MAX where neither is known. */
size_t tc_room_available(void);

/* TC_E_MEMORY, with a sentence that has both figures, when bytes are more than that; `what` begins the sentence ("preparing
 * 12 tetrahedra"). Where they are fewer than 256 MiB only TETCAST_MEMORY is asked. Cost: some 0.1 ms when the system is. */
tc_status tc_room_check(size_t bytes, tc_error *err, const char *what, ...) __attribute__((format(printf, 3, 4)));

#endif
