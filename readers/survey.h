// survey.h: what the mesh of a step will be like, without a mesh (request and result: readers/survey.c).
#ifndef TC_READERS_SURVEY_H
#define TC_READERS_SURVEY_H

#include "core/serve.h"
#include "step.h"

namespace tetcast
{

// What the last survey found out about a file, for its next step.
struct Surveyed {
    OpenFile file;
    bool there = false;        // of the points and cells whose hash is `input`:
    uint64_t input = 0;        //
    std::vector<int32_t> used; // the points that tets hold
    double bounds[6] = {0};    // of these
};

// Reads one step and answers with its range and bounds. Where cells may lose points or get new ones by splitting, they
// are split: to kept. Throws a Refusal; the file is then closed.
void survey(tc_serve *serve, Surveyed &surveyed, Kept &kept, json_t *json);

// Are the points that these tets hold those of the cells' corners, whatever diagonals they are cut by? used gets them,
// in their order. False: not surely so. points: from gather_points.
bool find_used(std::vector<int32_t> &used, const Tets &points, const Gathered &data, int refine);

} // namespace tetcast
#endif
