/* Embree, 3 or 4, as trees of boxes. */
#include <cmath>
#include <limits>
#include <mutex>
#include <new>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "solid/tree.h"

#if RTC_VERSION_MAJOR >= 4
using context_type = RTCRayQueryContext;
#define INITIALIZE_CONTEXT rtcInitRayQueryContext
#else
using context_type = RTCIntersectContext;
#define INITIALIZE_CONTEXT rtcInitIntersectContext
#endif

struct solid_tree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    solid_tree() = default;
    solid_tree(const solid_tree &) = delete;
    solid_tree &operator=(const solid_tree &) = delete;
    ~solid_tree() {
        if (scene)
            rtcReleaseScene(scene);
        if (device)
            rtcReleaseDevice(device);
    }
};

namespace {

struct ray_context {
    context_type embree; /* first: callbacks get a pointer to it */
    int32_t *found;
    int64_t count, capacity;
};

void bounds(const RTCBoundsFunctionArguments *arguments) {
    const float *box = static_cast<const float *>(arguments->geometryUserPtr) +
                       6 * static_cast<size_t>(arguments->primID);
    RTCBounds *out = arguments->bounds_o;
    out->lower_x = box[0];
    out->lower_y = box[1];
    out->lower_z = box[2];
    out->upper_x = box[3];
    out->upper_y = box[4];
    out->upper_z = box[5];
}

/* Take note of the box and report no hit, so that the ray goes on through all of them. */
void note(const RTCOccludedFunctionNArguments *arguments) {
    if (!arguments->valid[0])
        return;
    ray_context *context = reinterpret_cast<ray_context *>(arguments->context);
    if (context->count < context->capacity)
        context->found[context->count] = static_cast<int32_t>(arguments->primID);
    context->count++;
}

iso_status status_of(RTCDevice device) {
    switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
        return ISO_OK;
    case RTC_ERROR_OUT_OF_MEMORY:
        return ISO_NO_MEMORY;
    case RTC_ERROR_UNSUPPORTED_CPU:
        return ISO_BAD_CONFIG;
    default:
        return ISO_BUG;
    }
}

/* Of a call that gave nothing back: never ISO_OK. */
iso_status failure_of(RTCDevice device) {
    iso_status status = status_of(device);
    return status == ISO_OK ? ISO_BUG : status;
}

/* A scene of boxes. */
iso_status gather(RTCScene *result, RTCDevice device, const float *box, int32_t count) {
    RTCScene scene = rtcNewScene(device);
    *result = scene;
    if (!scene)
        return failure_of(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    if (!geometry)
        return failure_of(device);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry, const_cast<float *>(box));
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry, note);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return status_of(device);
}

iso_status build(solid_tree *tree, const float *box, int32_t count) {
    /* One thread: Embree's own would wait in a loop, and processor time is what counts. */
    tree->device = rtcNewDevice("threads=1,user_threads=1,set_affinity=0,verbose=0");
    if (!tree->device)
        return failure_of(nullptr);
    return gather(&tree->scene, tree->device, box, count);
}

iso_status tree_new(solid_tree **result, const float *box, int32_t count) {
    *result = nullptr;
    try {
        solid_tree *tree = new solid_tree;
        iso_status status = build(tree, box, count);
        if (status != ISO_OK) {
            delete tree;
            return status;
        }
        *result = tree;
        return ISO_OK;
    } catch (const std::bad_alloc &) {
        return ISO_NO_MEMORY;
    } catch (...) {
        return ISO_BUG;
    }
}

void tree_free(solid_tree *tree) {
    delete tree;
}

void shoot(ray_context *context, const solid_tree *tree, const float *origin, int32_t direction) {
    RTCRay ray = {};
    ray.org_x = origin[0];
    ray.org_y = origin[1];
    ray.org_z = origin[2];
    float *way = &ray.dir_x;
    way[direction / 2] = direction % 2 ? -1.0f : 1.0f;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context->embree;
    rtcOccluded1(tree->scene, &ray, &arguments);
#else
    rtcOccluded1(tree->scene, &context->embree, &ray);
#endif
}

iso_status tree_rays(int32_t *found, int32_t *first, int32_t *done, const solid_tree *tree,
                     const solid_rays *rays) {
    *done = 0;
    first[0] = 0;
    try {
        ray_context context;
        INITIALIZE_CONTEXT(&context.embree);
        for (int32_t i = 0; i < rays->count; i++) {
            context.found = found + first[i];
            context.count = 0;
            context.capacity = rays->capacity - first[i];
            shoot(&context, tree, rays->origin + 3 * static_cast<size_t>(i), rays->direction[i]);
            if (context.count > context.capacity) {
                if (i == 0)
                    first[1] = static_cast<int32_t>(context.count);
                return ISO_OK;
            }
            first[i + 1] = first[i] + static_cast<int32_t>(context.count);
            *done = i + 1;
        }
        return ISO_OK;
    } catch (...) {
        return ISO_BUG;
    }
}

struct pair_list {
    std::mutex lock; /* Embree may share the work out */
    int32_t *pair;
    int64_t count, capacity;
};

void note_pairs(void *payload, RTCCollision *collision, unsigned count) {
    pair_list *list = static_cast<pair_list *>(payload);
    std::lock_guard<std::mutex> guard(list->lock);
    for (unsigned i = 0; i < count; i++, list->count++) {
        if (list->count >= list->capacity)
            continue;
        list->pair[2 * list->count] = static_cast<int32_t>(collision[i].primID0);
        list->pair[2 * list->count + 1] = static_cast<int32_t>(collision[i].primID1);
    }
}

iso_status tree_boxes(int32_t *pair, int64_t *count, int64_t capacity, const solid_tree *tree,
                      const solid_boxes *boxes) {
    *count = 0;
    try {
        RTCScene scene = nullptr;
        iso_status status = gather(&scene, tree->device, boxes->box, boxes->count);
        if (status == ISO_OK) {
            pair_list list;
            list.pair = pair;
            list.count = 0;
            list.capacity = capacity;
            rtcCollide(tree->scene, scene, note_pairs, &list);
            *count = list.count;
            status = status_of(tree->device);
        }
        if (scene)
            rtcReleaseScene(scene);
        return status;
    } catch (const std::bad_alloc &) {
        return ISO_NO_MEMORY;
    } catch (...) {
        return ISO_BUG;
    }
}

} // namespace

MODULE_TABLE const solid_table isoslice_module = {
    {MODULE_VERSION_SOLID}, tree_new, tree_free, tree_rays, tree_boxes};
