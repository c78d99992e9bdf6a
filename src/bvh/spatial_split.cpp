// SPDX-License-Identifier: Apache-2.0
// Binning the parts of triangles, and cutting the items that reach over the chosen plane.
#include "bvh/spatial_split.h"

#include "bvh/clip.h"
#include "bvh/partition.h"

#include <algorithm>
#include <mutex>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

constexpr u32 FEW_SLAB_ITEMS = 64;
constexpr int FEW_SLABS = 8;

// Equal slabs of a node's box along all axes. Where rounding puts an item into the next slab, no harm is
// done: costs change by nothing to speak of, and items keep the boxes that they have.
struct Slabs {
    int count;
    Float4 origin, scale, width;
    bool used[3];

    Slabs(const Box& box, u32 items)
        : count(items < FEW_SLAB_ITEMS ? FEW_SLABS : MAX_BINS), origin(box.lower) {
        width = (box.upper - box.lower) * splat(1.0f / float(count));
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = 1.0f / width[axis];
            // A side without length, or too short for a float's reciprocal.
            used[axis] = scale[axis] < INFINITE_FLOAT;
            scale[axis] = used[axis] ? scale[axis] : 0;
        }
        origin[3] = scale[3] = width[3] = 0;
    }

    float plane(int axis, int slab) const { return origin[axis] + float(slab) * width[axis]; }

    // -1 and `count` stand for all that is outside.
    Int4 slabs_of(Float4 point) const {
        const Float4 position = (point - origin) * scale + splat(1);
        return __builtin_convertvector(lane_max(lane_min(position, splat(float(count + 1))), splat(0)),
                                       Int4) -
               1;
    }
};

// The slabs that an item reaches, one lane an axis.
struct SlabRange {
    Int4 first, last;

    SlabRange(const Box& box, const Slabs& slabs) {
        constexpr float BELOW_PLANE =
            1 - 0x1p-18f; // an item that ends at a plane is not in the slab behind it
        const Float4 end = splat(float(slabs.count - 1));
        const Float4 lower = (box.lower - slabs.origin) * slabs.scale;
        const Float4 upper = (box.upper - slabs.origin) * slabs.scale * splat(BELOW_PLANE);
        first = __builtin_convertvector(lane_min(lower, end), Int4);
        last = __builtin_convertvector(lane_min(upper, end), Int4);
        last = last < first ? first : last;
    }
};

// How many items begin and end in each slab, one lane an axis.
struct SlabCounts {
    Int4 entries[MAX_BINS] = {}, exits[MAX_BINS] = {};

    void add(const BuildItem& item, const Slabs& slabs) {
        const SlabRange range(item.box(), slabs);
        for (int axis = 0; axis < 3; ++axis) {
            ++entries[range.first[axis]][axis];
            ++exits[range.last[axis]][axis];
        }
    }
    void merge(const SlabCounts& other) {
        for (int b = 0; b < MAX_BINS; ++b) {
            entries[b] += other.entries[b];
            exits[b] += other.exits[b];
        }
    }
};

// The boxes of the items' parts in each slab. Only costs come from them: rounding need not be outwards.
struct SlabBoxes {
    Box boxes[3][MAX_BINS];

    void add(const BuildItem& item, const Slabs& slabs, const TriangleCorners& mesh) {
        const Box box = item.box();
        const SlabRange range(box, slabs);
        Float4 corners[3] = {};
        Int4 corner_slabs[3] = {};
        const Int4 crosses = range.first < range.last;
        if ((crosses[0] | crosses[1] | crosses[2]) != 0) {
            mesh.load(item.triangle(), corners);
            for (int i = 0; i < 3; ++i)
                corner_slabs[i] = slabs.slabs_of(corners[i]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (!slabs.used[axis])
                continue;
            if (crosses[axis])
                add_parts(box, corners, corner_slabs, axis, range.first[axis], range.last[axis], slabs);
            else
                boxes[axis][range.first[axis]].extend(box);
        }
    }
    void merge(const SlabBoxes& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int b = 0; b < MAX_BINS; ++b)
                boxes[axis][b].extend(other.boxes[axis][b]);
    }

private:
    // Each slab's part is around the corners in it and the points where edges cross its planes.
    void add_parts(const Box& box, const Float4* corners, const Int4* corner_slabs, int axis, int first,
                   int last, const Slabs& slabs) {
        Box parts[MAX_BINS];
        for (int i = 0; i < 3; ++i) {
            const int next = i == 2 ? 0 : i + 1;
            const int slab = corner_slabs[i][axis], next_slab = corner_slabs[next][axis];
            if (slab >= first && slab <= last)
                parts[slab].extend(corners[i]);
            const Float4 edge = corners[next] - corners[i];
            const float per_unit = 1.0f / edge[axis];
            const int end = std::min(std::max(slab, next_slab), last + 1);
            for (int b = std::max(std::min(slab, next_slab) + 1, first); b <= end; ++b) {
                const float share = (slabs.plane(axis, b) - corners[i][axis]) * per_unit;
                const Float4 crossing = corners[i] + splat(share) * edge;
                if (b > first)
                    parts[b - 1].extend(crossing);
                if (b <= last)
                    parts[b].extend(crossing);
            }
        }
        for (int b = first; b <= last; ++b) {
            parts[b].lower = lane_max(parts[b].lower, box.lower);
            parts[b].upper = lane_min(parts[b].upper, box.upper);
            if (!is_empty(parts[b]))
                boxes[axis][b].extend(parts[b]);
        }
    }
};

// Adds all items to bins, large ranges by several threads. Minima, maxima and integer sums do not depend on
// the order of merging.
template <class Bins, class Add>
void fill(Bins& bins, u32 count, const Add& add) {
    if (count < PARALLEL_ITEMS) {
        for (u32 i = 0; i < count; ++i)
            add(bins, i);
        return;
    }
    std::mutex mutex;
    tbb::parallel_for(tbb::blocked_range<u32>(0, count, ITEM_CHUNK),
                      [&](const tbb::blocked_range<u32>& part) {
                          Bins own;
                          for (u32 i = part.begin(); i != part.end(); ++i)
                              add(own, i);
                          const std::lock_guard<std::mutex> lock(mutex);
                          bins.merge(own);
                      });
}

// Relative edges, as in find_split.
float relative_scale(const Box& box) {
    const Float4 edge = box.upper - box.lower;
    return std::min(1.0f / std::max({edge[0], edge[1], edge[2]}), std::numeric_limits<float>::max());
}

float side_cost(const Box& box, u32 count, float scale, const LeafCost& leaf_cost) {
    return half_area(box, scale) * leaf_cost.blocks(Int4{} + i32(count))[0];
}

// How many items a plane would leave on either side; 0 on the left where it is of no use.
struct PlaneCounts {
    u32 left[MAX_BINS] = {}, right[MAX_BINS] = {};
};

// Fills the counts of the planes that leave both sides something, fewer than all, and need at most `spare`
// new items. Returns whether there are any.
bool useful_planes(const SlabCounts& counts, int slabs, int axis, u32 count, u32 spare, PlaneCounts& planes) {
    u32 left = 0, ended = 0;
    bool any = false;
    for (int b = 1; b < slabs; ++b) {
        left += u32(counts.entries[b - 1][axis]);
        ended += u32(counts.exits[b - 1][axis]);
        const u32 right = count - ended;
        if (left == 0 || right == 0 || left == count || right == count || left - ended > spare)
            continue;
        planes.left[b] = left;
        planes.right[b] = right;
        any = true;
    }
    return any;
}

// Sweeps one axis from both ends.
void sweep_slabs(const Box* boxes, const PlaneCounts& counts, const Slabs& slabs, int axis, float scale,
                 const LeafCost& leaf_cost, SpatialSplit& best) {
    Box right_boxes[MAX_BINS];
    Box box;
    for (int b = slabs.count - 1; b > 0; --b) {
        box.extend(boxes[b]);
        right_boxes[b] = box;
    }
    box = Box();
    for (int b = 1; b < slabs.count; ++b) {
        box.extend(boxes[b - 1]);
        const u32 left = counts.left[b], right = counts.right[b];
        if (left == 0 || is_empty(box) || is_empty(right_boxes[b]))
            continue;
        const float cost =
            side_cost(box, left, scale, leaf_cost) + side_cost(right_boxes[b], right, scale, leaf_cost);
        if (cost < best.cost)
            best = {axis, b, slabs.plane(axis, b), left, right, box, right_boxes[b], cost};
    }
}

// The fourth lane of an item's upper corner says where it goes while a split is applied.
void mark_side(BuildItem& item, bool is_left) {
    item.upper[3] = is_left ? 1.0f : 0.0f;
}

struct ChunkCut {
    ItemBounds left, right;
    std::vector<BuildItem> extra; // right parts of cut items
};

// Decides about items one by one, against the sides as they were found: the order does not matter.
class ItemCutter {
public:
    ItemCutter(const TriangleCorners& mesh, const Slabs& slabs, const SpatialSplit& split, float scale,
               const LeafCost& leaf_cost)
        : mesh_(mesh), slabs_(slabs), split_(split), scale_(scale), leaf_cost_(leaf_cost),
          left_cost_(side_cost(split.left, split.left_count, scale, leaf_cost)),
          right_cost_(side_cost(split.right, split.right_count, scale, leaf_cost)),
          left_cost_without_(side_cost(split.left, split.left_count - 1, scale, leaf_cost)),
          right_cost_without_(side_cost(split.right, split.right_count - 1, scale, leaf_cost)) {}

    void cut(BuildItem& item, ChunkCut& chunk) const {
        const Box box = item.box();
        // As counted, or fewer cuts: there may be no room for more.
        const SlabRange range(box, slabs_);
        if (range.first[split_.axis] >= split_.slab || box.lower[split_.axis] >= split_.position)
            return keep(item, false, chunk);
        if (range.last[split_.axis] < split_.slab || box.upper[split_.axis] <= split_.position)
            return keep(item, true, chunk);
        Float4 corners[3] = {};
        mesh_.load(item.triangle(), corners);
        const BoxParts parts = cut_box(box, corners, split_.axis, split_.position);
        // The box reaches over the plane but the triangle's part in it may not.
        if (is_empty(parts.right))
            return keep(item, true, chunk);
        if (is_empty(parts.left))
            return keep(item, false, chunk);
        // Whole items on one side (section 4.4 of the paper), where that is cheaper than both parts.
        const float both = left_cost_ + right_cost_;
        const float left_only = extended(split_.left, split_.left_count, box) + right_cost_without_;
        const float right_only = extended(split_.right, split_.right_count, box) + left_cost_without_;
        if (std::min(left_only, right_only) <= both && split_.left_count > 1 && split_.right_count > 1)
            return keep(item, left_only <= right_only, chunk);
        chunk.extra.emplace_back(parts.right, item.triangle());
        mark_side(chunk.extra.back(), false);
        chunk.right.extend(parts.right);
        item = BuildItem(parts.left, item.triangle());
        keep(item, true, chunk);
    }

private:
    static void keep(BuildItem& item, bool is_left, ChunkCut& chunk) {
        mark_side(item, is_left);
        (is_left ? chunk.left : chunk.right).extend(item.box());
    }
    float extended(Box side, u32 count, const Box& item) const {
        side.extend(item);
        return side_cost(side, count, scale_, leaf_cost_);
    }

    const TriangleCorners& mesh_;
    const Slabs slabs_;
    const SpatialSplit& split_;
    float scale_;
    LeafCost leaf_cost_;
    float left_cost_, right_cost_, left_cost_without_, right_cost_without_;
};

} // namespace

SpatialSplit find_spatial_split(const TriangleCorners& mesh, const BuildItem* items, u32 count, u32 spare,
                                const Box& box, const LeafCost& leaf_cost) {
    // Counting is cheap and shows which axes are worth cutting parts for.
    Slabs slabs(box, count);
    SlabCounts counts;
    fill(counts, count, [&](SlabCounts& to, u32 i) { to.add(items[i], slabs); });
    PlaneCounts planes[3];
    for (int axis = 0; axis < 3; ++axis)
        slabs.used[axis] =
            slabs.used[axis] && useful_planes(counts, slabs.count, axis, count, spare, planes[axis]);
    SpatialSplit best;
    if (!slabs.used[0] && !slabs.used[1] && !slabs.used[2])
        return best;
    SlabBoxes bins;
    fill(bins, count, [&](SlabBoxes& to, u32 i) { to.add(items[i], slabs, mesh); });
    const float scale = relative_scale(box);
    for (int axis = 0; axis < 3; ++axis)
        if (slabs.used[axis])
            sweep_slabs(bins.boxes[axis], planes[axis], slabs, axis, scale, leaf_cost, best);
    best.cost += half_area(box, scale) * leaf_cost.node_cost;
    return best;
}

SpatialSides apply_spatial_split(const TriangleCorners& mesh, BuildItem* items, u32 count, const Box& box,
                                 const SpatialSplit& split, const LeafCost& leaf_cost) {
    // Cut and mark fixed chunks side by side.
    const ItemCutter cutter(mesh, Slabs(box, count), split, relative_scale(box), leaf_cost);
    std::vector<ChunkCut> chunks((count + ITEM_CHUNK - 1) / ITEM_CHUNK);
    const auto cut_chunk = [&](size_t i) {
        const u32 end = std::min((u32(i) + 1) * ITEM_CHUNK, count);
        for (u32 k = u32(i) * ITEM_CHUNK; k < end; ++k)
            cutter.cut(items[k], chunks[i]);
    };
    if (chunks.size() == 1)
        cut_chunk(0);
    else
        tbb::parallel_for(size_t(0), chunks.size(), cut_chunk);
    // Partition by the marks and append the new parts.
    SpatialSides result;
    result.sides =
        partition_items(items, count, [](const BuildItem& item, SplitSides&) { return item.upper[3] != 0; });
    u32 total = count;
    for (const ChunkCut& chunk : chunks) {
        result.sides.left.extend(chunk.left);
        result.sides.right.extend(chunk.right);
        std::copy(chunk.extra.begin(), chunk.extra.end(), items + total);
        total += u32(chunk.extra.size());
    }
    result.right_count = total - result.sides.left_count;
    return result;
}

} // namespace clrt
