// fields.cpp: the arrays a file offers, and the one that is rendered.
#include "fields.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace tetcast
{

static const double no_value = std::numeric_limits<double>::quiet_NaN();

static vtkDataSetAttributes *attributes(const Leaf &leaf, tc_association association)
{
    if (association == TC_CELL_DATA)
        return leaf.data->GetCellData();
    return leaf.data->GetPointData();
}

static size_t tuples(const Leaf &leaf, tc_association association)
{
    return (size_t)(association == TC_CELL_DATA ? leaf.data->GetNumberOfCells() : leaf.data->GetNumberOfPoints());
}

// The leaf's array when it is numeric and long enough, else NULL.
static vtkDataArray *array_of(const Leaf &leaf, const std::string &name, tc_association association)
{
    vtkDataArray *array = attributes(leaf, association)->GetArray(name.c_str());
    if (!array || (size_t)array->GetNumberOfTuples() < tuples(leaf, association))
        return nullptr;
    return array;
}

bool is_bookkeeping(const std::string &name)
{
    static const char *const names[] = {"GlobalNodeId",
                                        "GlobalElementId",
                                        "ObjectId",
                                        "PedigreeNodeId",
                                        "PedigreeElementId",
                                        "vtkOriginalPointIds",
                                        "vtkOriginalCellIds",
                                        "vtkGhostType",
                                        "vtkGhostLevels",
                                        "vtkBlockColors",
                                        "vtkCompositeIndex",
                                        "Normals"};
    for (const char *known : names)
        if (name == known)
            return true;
    return false;
}

const char *const block_array = "vtkCompositeIndex";

// The arrays that number blocks; `--blocks` knows the same (src/cli/look_build.c).
static bool numbers_blocks(const std::string &name)
{
    static const char *const names[] = {"ObjectId", block_array,       "BlockId",              "BlockID",
                                        "block_id", "ElementBlockIds", "GlobalElementBlockId", "Block"};
    return std::any_of(std::begin(names), std::end(names), [&](const char *known) { return name == known; });
}

static bool same_association(tc_association wish, tc_association is)
{
    return wish == TC_ANY_DATA || wish == is;
}

// "U:1" -> "U", "1"; false without a colon.
static bool split_wish(const std::string &text, std::string &name, std::string &component)
{
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos)
        return false;
    name = text.substr(0, colon);
    component = text.substr(colon + 1);
    return true;
}

bool may_be_wanted(const FieldWish &wish, const std::string &name, tc_association association)
{
    if (!same_association(wish.association, association))
        return false;
    if (wish.any)
        return true;
    std::string base, component;
    return wish.text == name || (split_wish(wish.text, base, component) && base == name);
}

static std::string listing(const std::vector<Offered> &offered)
{
    std::string text;
    for (tc_association association : {TC_POINT_DATA, TC_CELL_DATA}) {
        std::string names;
        for (const Offered &o : offered)
            if (o.association == association)
                names += (names.empty() ? "" : ", ") + o.name;
        if (!names.empty())
            text += (text.empty() ? "" : "; ") +
                    std::string(association == TC_POINT_DATA ? "point arrays " : "cell arrays ") + names;
    }
    return text.empty() ? "there are none" : "there are " + text;
}

void require_wanted(const std::string &path, const FieldWish &wish, const std::vector<Offered> &offered)
{
    for (const Offered &o : offered)
        if (may_be_wanted(wish, o.name, o.association) && !(wish.any && o.block_numbers))
            return;
    if (wish.any && wish.association == TC_ANY_DATA)
        return;
    const char *kind = wish.association == TC_POINT_DATA ? "point " : wish.association == TC_CELL_DATA ? "cell " : "";
    throw Refusal(path + " has no " + kind + "array" + (wish.any ? "" : " \"" + wish.text + "\"") + "; " +
                  listing(offered));
}

void list_read_arrays(std::vector<Offered> &offered, const Gathered &data)
{
    for (tc_association association : {TC_POINT_DATA, TC_CELL_DATA})
        for (const Leaf &leaf : data.leaf) {
            vtkDataSetAttributes *all = attributes(leaf, association);
            for (int i = 0; i < all->GetNumberOfArrays(); i++) {
                vtkDataArray *array = all->GetArray(i); // NULL for strings
                if (!array || !array->GetName() || std::string(array->GetName()) == "vtkGhostType" ||
                    (size_t)array->GetNumberOfTuples() < tuples(leaf, association))
                    continue;
                const std::string name = array->GetName();
                auto at = std::find_if(offered.begin(), offered.end(), [&](const Offered &o) {
                    return o.name == name && o.association == association;
                });
                if (at == offered.end()) {
                    offered.emplace_back();
                    at = offered.end() - 1;
                    at->name = name;
                    at->association = association;
                }
                if (at->components == 0) {
                    at->components = array->GetNumberOfComponents();
                    for (int k = 0; k < at->components; k++)
                        at->component_name.push_back(array->GetComponentName(k) ? array->GetComponentName(k) : "");
                }
            }
        }
    for (Offered &o : offered)
        if (o.components > 0)
            for (const Leaf &leaf : data.leaf)
                o.blocks_without += !array_of(leaf, o.name, o.association) && tuples(leaf, o.association) > 0;
}

void list_block_numbers(std::vector<Offered> &offered, std::vector<Block> &blocks, const Gathered &data)
{
    const bool there = std::any_of(offered.begin(), offered.end(), [](const Offered &o) {
        return o.association == TC_CELL_DATA && numbers_blocks(o.name);
    });
    if (there) { // by VTK: the reader knew of it before it knew of all arrays
        std::stable_partition(offered.begin(), offered.end(), [](const Offered &o) { return !o.block_numbers; });
    } else if (data.leaf.size() > 1) {
        offered.emplace_back();
        offered.back().name = block_array;
        offered.back().association = TC_CELL_DATA;
        offered.back().components = 1;
        offered.back().component_name = {""};
        offered.back().block_numbers = true;
        for (const Leaf &leaf : data.leaf)
            blocks.push_back({leaf.block, leaf.name});
    }
}

// The component, or the magnitude of all.
static double value_of(vtkDataArray *array, size_t tuple, int component)
{
    if (component >= 0)
        return array->GetComponent((vtkIdType)tuple, component);
    double sum = 0;
    for (int k = 0; k < array->GetNumberOfComponents(); k++) {
        const double v = array->GetComponent((vtkIdType)tuple, k);
        sum += v * v;
    }
    return std::sqrt(sum);
}

void find_ranges(std::vector<Offered> &offered, const Gathered &data,
                 const std::function<bool(const Offered &)> &wanted)
{
    for (Offered &o : offered) {
        if (o.components == 0 || !wanted(o))
            continue;
        o.ranged = true;
        o.lo = std::numeric_limits<double>::infinity();
        o.hi = -o.lo;
        for (const Leaf &leaf : data.leaf) {
            vtkDataArray *array = array_of(leaf, o.name, o.association);
            if (!array && o.block_numbers && tuples(leaf, o.association) > 0) {
                o.lo = std::min(o.lo, (double)leaf.block);
                o.hi = std::max(o.hi, (double)leaf.block);
            }
            if (!array)
                continue;
            const size_t n = tuples(leaf, o.association);
            for (size_t i = 0; i < n; i++) {
                const double v = value_of(array, i, array->GetNumberOfComponents() > 1 ? -1 : 0);
                if (std::isfinite(v)) {
                    o.lo = std::min(o.lo, v);
                    o.hi = std::max(o.hi, v);
                }
            }
        }
    }
}

static std::string lower(std::string s)
{
    for (char &c : s)
        c = (char)std::tolower((unsigned char)c);
    return s;
}

// Index of a component by number, by the file's own name, or by x, y, z; -1 magnitude; -2 unknown.
static int component_index(const Offered &o, const std::string &text)
{
    if (lower(text) == "magnitude" || lower(text) == "mag")
        return -1;
    for (int k = 0; k < o.components; k++)
        if (!o.component_name[(size_t)k].empty() && o.component_name[(size_t)k] == text)
            return k;
    if (!text.empty() && text.size() < 9 &&
        std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) {
        const int k = std::stoi(text);
        return k < o.components ? k : -2;
    }
    if (text.size() == 1 && o.components <= 3) {
        const size_t k = std::string("xyz").find(lower(text));
        if (k != std::string::npos && (int)k < o.components)
            return (int)k;
    }
    return -2;
}

Chosen choose_field(const std::string &path, const FieldWish &wish, const std::vector<Offered> &offered)
{
    require_wanted(path, wish, offered);
    Chosen chosen;
    const Offered *best = nullptr;
    std::string base, suffix;
    const bool has_suffix = !wish.any && split_wish(wish.text, base, suffix);
    bool whole = true; // the wish is a name as it stands
    for (int pass = 0; pass < 2 && !best; pass++) {
        for (tc_association association : {TC_POINT_DATA, TC_CELL_DATA}) {
            for (const Offered &o : offered) {
                if (o.components == 0 || (wish.any && o.block_numbers) || o.association != association ||
                    !same_association(wish.association, association))
                    continue;
                const bool match = wish.any    ? (pass == 1 || !is_bookkeeping(o.name))
                                   : pass == 0 ? o.name == wish.text
                                               : has_suffix && o.name == base;
                if (match && !best) {
                    best = &o;
                    whole = wish.any || pass == 0;
                }
            }
        }
    }
    if (!best) {
        if (wish.any)
            return chosen;
        throw Refusal(path + " holds no numbers for array \"" + wish.text + "\" at this step; " + listing(offered));
    }
    chosen.none = false;
    chosen.name = best->name;
    chosen.association = best->association;
    chosen.components = best->components;
    chosen.component = best->components > 1 ? -1 : 0;
    chosen.block_numbers = best->block_numbers;
    if (!whole) {
        chosen.component = component_index(*best, suffix);
        if (chosen.component == -2)
            throw Refusal(path + ": array \"" + best->name + "\" has no component \"" + suffix + "\"; it has " +
                          std::to_string(best->components) + " (0 to " + std::to_string(best->components - 1) +
                          ") and magnitude");
    }
    chosen.label = best->name;
    if (chosen.component < 0)
        chosen.label += ":magnitude";
    else if (best->components > 1)
        chosen.label += ":" + suffix;
    return chosen;
}

void point_values(double *out, const Chosen &chosen, const Gathered &data, const Tets &tets, const int32_t *point,
                  size_t n)
{
    // Added points interpolate components, then take the magnitude.
    std::vector<vtkDataArray *> array;
    for (const Leaf &leaf : data.leaf)
        array.push_back(array_of(leaf, chosen.name, TC_POINT_DATA));
    const auto leaf_of = [&](size_t id) {
        size_t k = 0;
        if (data.leaf.size() > 1) {
            const auto at = std::upper_bound(data.leaf.begin(), data.leaf.end(), id,
                                             [](size_t v, const Leaf &leaf) { return v < leaf.first_point; });
            k = (size_t)(at - data.leaf.begin()) - 1;
        }
        return k;
    };
    for (size_t i = 0; i < n; i++) {
        const size_t id = (size_t)point[i];
        if (id < tets.n_file_point) {
            const size_t k = leaf_of(id);
            const bool fits = array[k] && array[k]->GetNumberOfComponents() > chosen.component;
            out[i] = fits ? value_of(array[k], id - data.leaf[k].first_point, chosen.component) : no_value;
            continue;
        }
        const size_t added = id - tets.n_file_point;
        const int first = std::max(chosen.component, 0);
        const int last = chosen.component < 0 ? chosen.components - 1 : chosen.component;
        double square = 0, plain = 0;
        for (int c = first; c <= last; c++) {
            double sum = 0;
            for (size_t w = tets.weight_first[added]; w < tets.weight_first[added + 1]; w++) {
                const size_t from = (size_t)tets.weight_id[w];
                const size_t k = leaf_of(from);
                const bool fits = array[k] && array[k]->GetNumberOfComponents() > c;
                if (tets.weight[w] != 0)
                    sum += tets.weight[w] *
                           (fits ? array[k]->GetComponent((vtkIdType)(from - data.leaf[k].first_point), c) : no_value);
            }
            plain = sum;
            square += sum * sum;
        }
        out[i] = chosen.component < 0 ? std::sqrt(square) : plain;
    }
}

void cell_values(double *out, const Chosen &chosen, const Gathered &data, const int64_t *cell, size_t n)
{
    size_t k = 0;
    vtkDataArray *array = nullptr;
    size_t of = (size_t)-1;
    for (size_t i = 0; i < n; i++) {
        const size_t id = (size_t)cell[i];
        while (k + 1 < data.leaf.size() && id >= data.leaf[k + 1].first_cell)
            k++;
        while (k > 0 && id < data.leaf[k].first_cell)
            k--;
        if (of != k) {
            array = array_of(data.leaf[k], chosen.name, TC_CELL_DATA);
            of = k;
        }
        const bool fits = array && array->GetNumberOfComponents() > chosen.component;
        const double without = chosen.block_numbers ? (double)data.leaf[k].block : no_value;
        out[i] = fits ? value_of(array, id - data.leaf[k].first_cell, chosen.component) : without;
    }
}

} // namespace tetcast
