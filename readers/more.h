// more.h: the entry of the module tetcast-read-more.so.
#ifndef TC_READERS_MORE_H
#define TC_READERS_MORE_H

#include "load.h"

#define TETCAST_MORE "tetcast-read-more.so"

// A reader for VTKHDF and the formats of solvers; the caller's. Throws a Refusal.
extern "C" tetcast::Reader *tetcast_more_reader(const std::string &path, const tc_sniffed &sniffed);

#endif
