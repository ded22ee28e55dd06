// step.h: one step of a file as VTK's data, and its cells as tets: what reading and surveying have in common.
#ifndef TC_READERS_STEP_H
#define TC_READERS_STEP_H

#include "kept.h"
#include "load.h"

namespace tetcast
{

// What is asked for. Throws a Refusal when no file is named.
ReadRequest parse_request(json_t *request);

struct Step {
    Loaded loaded;
    Gathered data; // has cells of dimension 3
    Chosen chosen;
};

// Reads the step. open: as of load_file. Throws a Refusal.
void load_step(Step &out, const ReadRequest &request, OpenFile *open, VtkTalk &talk);

// The tets of data, in kept or, where the request lets nothing be kept, in fresh: those of the last request where its
// points and cells were the same. Throws a Refusal when there are none.
const SplitFile &split_step(Kept &kept, SplitFile &fresh, const ReadRequest &request, const Gathered &data,
                            VtkTalk &talk);

} // namespace tetcast
#endif
