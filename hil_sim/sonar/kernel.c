// SPDX-License-Identifier: MIT
// The echo model of hil_sim/sonar/echo.py in C: same sums in the same order, so the same millimetres.
#include "echo.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

// What is heard from one grid cell of a world, or what moves in it. The arrays are the caller's and must
// stay. `inverse` holds four values for each corner; `retro` is 1 for one that can send sound back.
struct patch {
    double *ax, *ay, *ex, *ey;
    const double *length, *mirror;
    double *corner_x, *corner_y;
    const double *inverse, *retro;
    int32_t segments, corners;
};

// What can lie within a cone that looks into one part of the compass from anywhere in a cell.
typedef struct {
    int32_t *items; // numbers of segments, then of corners; NULL: not listed yet
    int32_t segments, corners;
} sector_t;

typedef struct {
    int32_t column, row;
    const patch_t *patch; // NULL: the slot is free
    sector_t *sectors;
} slot_t;

typedef struct {
    double cone_deg, cos_half, edge_db, margin_db, air_db_mm, corner_db, tip_db, side_lobe_db;
    double min_mm, no_echo_mm, cell_mm, touch;
    const double *ray_cos, *ray_sin, *ray_db; // `rays` each
    const double *mount;                      // x, y, heading of each sonar
    int32_t rays, sonars;
} model_t;

// A segment that a ray of the cone may meet, relative to the transducer.
typedef struct {
    double wx, wy, ex, ey, num, length, mirror;
    double least; // no point of it is nearer
} near_t;

struct echo {
    model_t model;
    slot_t *slots;
    uint32_t capacity, used; // capacity: a power of two
    near_t *near;
    int32_t room;
};

enum { FIRST_CAPACITY = 64, SECTORS = 24 };

typedef struct {
    double x, y, c, s;
} view_t;

// Part of a patch: all of it where `items` is NULL.
typedef struct {
    const patch_t *patch;
    const int32_t *items;
    int32_t segments, corners;
} part_t;

echo_t *argus_sim_echo_new(const model_t *model);
void argus_sim_echo_free(echo_t *self);
int32_t argus_sim_echo_add(echo_t *self, int32_t column, int32_t row, const patch_t *patch);
int32_t argus_sim_echo_range(echo_t *self, double x, double y, double heading_deg, double gain_db,
                             const patch_t *others);
uint32_t argus_sim_version(void);

uint32_t argus_sim_version(void) {
    return 7;
}

static const double deg_per_rad = 180.0 / 3.14159265358979323846;
static const double rad_per_deg = 3.14159265358979323846 / 180.0;

// ---- cells ------------------------------------------------------------------------------------------------

echo_t *argus_sim_echo_new(const model_t *const model) {
    echo_t *const self = calloc(1, sizeof *self);
    slot_t *const slots = calloc(FIRST_CAPACITY, sizeof *slots);
    if (self == NULL || slots == NULL) {
        free(self);
        free(slots);
        return NULL;
    }
    self->model = *model;
    self->slots = slots;
    self->capacity = FIRST_CAPACITY;
    return self;
}

static void free_sectors(sector_t *const sectors) {
    for (int32_t k = 0; sectors != NULL && k < SECTORS; k++) {
        free(sectors[k].items);
    }
    free(sectors);
}

void argus_sim_echo_free(echo_t *const self) {
    if (self != NULL) {
        for (uint32_t k = 0; k < self->capacity; k++) {
            free_sectors(self->slots[k].sectors);
        }
        free(self->slots);
        free(self->near);
        free(self);
    }
}

static slot_t *slot_of(slot_t *const slots, const uint32_t capacity, const int32_t column,
                       const int32_t row) {
    uint32_t at = ((uint32_t)column * 2654435761u ^ (uint32_t)row * 2246822519u) & (capacity - 1);
    while (slots[at].patch != NULL && (slots[at].column != column || slots[at].row != row)) {
        at = (at + 1) & (capacity - 1);
    }
    return &slots[at];
}

static bool grow(echo_t *const self) {
    const uint32_t capacity = self->capacity * 2;
    slot_t *const slots = calloc(capacity, sizeof *slots);
    if (slots == NULL) {
        return false;
    }
    for (uint32_t k = 0; k < self->capacity; k++) {
        const slot_t old = self->slots[k];
        if (old.patch != NULL) {
            *slot_of(slots, capacity, old.column, old.row) = old;
        }
    }
    free(self->slots);
    self->slots = slots;
    self->capacity = capacity;
    return true;
}

static bool reserve(echo_t *const self, const int32_t segments) {
    if (segments > self->room) {
        free(self->near);
        self->near = malloc((size_t)segments * sizeof *self->near);
        self->room = self->near != NULL ? segments : 0;
    }
    return self->near != NULL;
}

int32_t argus_sim_echo_add(echo_t *const self, const int32_t column, const int32_t row,
                           const patch_t *const patch) {
    if (self->used * 2 >= self->capacity && !grow(self)) {
        return NO_MEMORY;
    }
    sector_t *const sectors = calloc(SECTORS, sizeof *sectors);
    if (sectors == NULL) {
        return NO_MEMORY;
    }
    slot_t *const slot = slot_of(self->slots, self->capacity, column, row);
    self->used += slot->patch == NULL;
    free_sectors(slot->sectors);
    *slot = (slot_t){column, row, patch, sectors};
    return 0;
}

void argus_sim_place(patch_t *const here, const patch_t *const shape, const int32_t *const owner,
                     const int32_t *const corner_owner, const double *const places) {
    for (int32_t k = 0; k < shape->segments; k++) {
        const double *const at = &places[4 * owner[k]];
        const double c = at[2], s = at[3];
        here->ax[k] = at[0] + shape->ax[k] * c - shape->ay[k] * s;
        here->ay[k] = at[1] + shape->ax[k] * s + shape->ay[k] * c;
        here->ex[k] = shape->ex[k] * c - shape->ey[k] * s;
        here->ey[k] = shape->ex[k] * s + shape->ey[k] * c;
    }
    for (int32_t k = 0; k < shape->corners; k++) {
        const double *const at = &places[4 * corner_owner[k]];
        here->corner_x[k] = at[0] + shape->corner_x[k] * at[2] - shape->corner_y[k] * at[3];
        here->corner_y[k] = at[1] + shape->corner_x[k] * at[3] + shape->corner_y[k] * at[2];
    }
}

// ---- echoes -----------------------------------------------------------------------------------------------

// What the transducer can meet; `first` is what the numpy model takes for met by a ray that meets nothing.
typedef struct {
    near_t *near, *nearer; // `nearer`: those that could be heard nearer than what has been heard
    int32_t count, nearer_count;
    near_t first;
    double margin_db; // loss at which an echo is no longer heard
} scene_t;

typedef struct {
    double range, inverse;
    const near_t *near; // NULL: nothing was hit
} hit_t;

// The half planes outside a cone: beyond its left side, beyond its right side, behind it.
typedef struct {
    double x[3], y[3], margin;
} outside_t;

static outside_t outside(const double c, const double s, const double cos_half, const double margin) {
    const double sin_half = sqrt(1 - cos_half * cos_half);
    return (outside_t){{-s * cos_half - c * sin_half, s * cos_half - c * sin_half, -c},
                       {c * cos_half - s * sin_half, -c * cos_half - s * sin_half, -s},
                       margin};
}

// The whole segment is in one of the half planes, by more than the margin: no ray meets it.
static bool misses(const outside_t *const out, const double x, const double y, const double ex,
                   const double ey) {
    bool missed = false;
    for (int k = 0; k < 3; k++) {
        const double one = x * out->x[k] + y * out->y[k];
        missed |= one > out->margin && one + ex * out->x[k] + ey * out->y[k] > out->margin;
    }
    return missed;
}

static near_t relative(const patch_t *const patch, const int32_t k, const view_t view) {
    const double wx = patch->ax[k] - view.x, wy = patch->ay[k] - view.y;
    const double ex = patch->ex[k], ey = patch->ey[k], length = patch->length[k];
    const double part = fmin(1.0, fmax(0.0, -(wx * ex + wy * ey) / (length * length)));
    const double x = wx + part * ex, y = wy + part * ey;
    const double least = sqrt(x * x + y * y) - 0.01;
    return (near_t){wx, wy, ex, ey, wx * ey - wy * ex, length, patch->mirror[k], least};
}

static bool list_sector(const model_t *const model, const slot_t *const slot, const int32_t number) {
    const patch_t *const patch = slot->patch;
    sector_t *const sector = &slot->sectors[number];
    const double middle = (number + 0.5) * (360.0 / (double)SECTORS) * rad_per_deg;
    const double half = acos(model->cos_half) + (180.0 / (double)SECTORS + 0.1) * rad_per_deg;
    // From anywhere in the cell, and what rounding may add.
    const double radius = model->cell_mm * 0.75 + 2.0;
    const outside_t out = outside(cos(middle), sin(middle), cos(half), radius);
    const double x = (slot->column + 0.5) * model->cell_mm, y = (slot->row + 0.5) * model->cell_mm;
    int32_t *const items = malloc((size_t)(patch->segments + patch->corners + 1) * sizeof *items);
    if (items == NULL) {
        return false;
    }
    int32_t count = 0;
    for (int32_t k = 0; k < patch->segments; k++) {
        items[count] = k;
        count += !misses(&out, patch->ax[k] - x, patch->ay[k] - y, patch->ex[k], patch->ey[k]);
    }
    sector->segments = count;
    for (int32_t k = 0; k < patch->corners; k++) {
        const double dx = patch->corner_x[k] - x, dy = patch->corner_y[k] - y;
        items[count] = k;
        count += !misses(&out, dx, dy, 0, 0) && sqrt(dx * dx + dy * dy) < model->no_echo_mm + radius;
    }
    sector->corners = count - sector->segments;
    sector->items = items;
    return true;
}

// What of a cell a transducer with this heading may hear; `patch` NULL: no memory.
static part_t part_of(const model_t *const model, const slot_t *const slot, const double heading_deg) {
    const double turns = heading_deg / 360.0;
    const int32_t number = (int32_t)((turns - floor(turns)) * (double)SECTORS) % SECTORS;
    const sector_t *const sector = &slot->sectors[number];
    if (sector->items == NULL && !list_sector(model, slot, number)) {
        return (part_t){NULL, NULL, 0, 0};
    }
    return (part_t){slot->patch, sector->items, sector->segments, sector->corners};
}

static int32_t gather(near_t *const near, const double cos_half, const part_t *const part,
                      const view_t view) {
    const outside_t out = outside(view.c, view.s, cos_half, 1.0);
    int32_t count = 0;
    for (int32_t k = 0; k < part->segments; k++) {
        near_t *const one = &near[count];
        *one = relative(part->patch, part->items != NULL ? part->items[k] : k, view);
        count += !misses(&out, one->wx, one->wy, one->ex, one->ey);
    }
    return count;
}

// The first of these segments that a ray meets.
static hit_t cast(const near_t *const nears, const int32_t count, const double dir_x, const double dir_y,
                  const double touch) {
    hit_t first = {INFINITY, 0.0, NULL};
    for (int32_t k = 0; k < count; k++) {
        const near_t *const near = &nears[k];
        const double inverse = 1.0 / (dir_x * near->ey - dir_y * near->ex);
        const double where = (dir_y * near->wx - dir_x * near->wy) * inverse;
        const double range = near->num * inverse;
        // Written so that a ray along a segment (NaN) misses it.
        if (where >= -touch && where <= 1 + touch && range > 0 && range < first.range) {
            first = (hit_t){range, inverse, near};
        }
    }
    return first;
}

static double surface_db(const scene_t *const scene, hit_t hit, const double dir_x, const double dir_y) {
    if (hit.near == NULL) {
        hit.near = &scene->first;
        hit.inverse = 1.0 / (dir_x * hit.near->ey - dir_y * hit.near->ex);
    }
    const double cosine = fabs(1.0 / (hit.inverse * hit.near->length));
    const double degrees = acos(cosine < 1.0 ? cosine : 1.0) * deg_per_rad;
    return hit.near->mirror * (degrees * degrees) - 20 * log10(cosine);
}

static double hear_fan(const model_t *const model, const scene_t *const scene, const view_t view,
                       double nearest) {
    for (int32_t k = 0; k < model->rays; k++) {
        const double dir_x = model->ray_cos[k] * view.c - model->ray_sin[k] * view.s;
        const double dir_y = model->ray_cos[k] * view.s + model->ray_sin[k] * view.c;
        const hit_t hit = cast(scene->near, scene->count, dir_x, dir_y, model->touch);
        if (hit.near != NULL && hit.range < nearest) {
            const double loss =
                surface_db(scene, hit, dir_x, dir_y) + model->ray_db[k] + model->air_db_mm * hit.range;
            if (loss <= scene->margin_db) {
                nearest = hit.range;
            }
        }
    }
    return nearest;
}

static double corner_loss_db(const model_t *const model, const patch_t *const patch, const int32_t k,
                             const double dx, const double dy) {
    const double *const inverse = &patch->inverse[4 * k];
    // The transducer looks into the corner when the way back is a positive mix of the corner's arms.
    const bool into = inverse[0] * dx + inverse[1] * dy < 0 && inverse[2] * dx + inverse[3] * dy < 0;
    return into && patch->retro[k] > 0 ? model->corner_db : model->tip_db;
}

// The first of these segments that is met on the way to a corner; what lies beyond `nearest` is left out.
static hit_t cast_at_corner(const scene_t *const scene, const double dx, const double dy, const double far,
                            const double nearest, const double touch) {
    const hit_t hit = cast(scene->nearer, scene->nearer_count, dx, dy, touch);
    if (hit.range < nearest || far >= nearest) {
        return hit;
    }
    // It slipped past the corner: what it meets behind is among those left out.
    return cast(scene->near, scene->count, dx, dy, touch);
}

// Loss of the beam, there and back, `off` half widths of the cone from the axis.
static double beam_db(const model_t *const model, const double off) {
    return off > 1 && model->side_lobe_db > 0 ? model->side_lobe_db : model->edge_db * off * off;
}

// Where sound comes back from when sent to a corner within the cone. INFINITY: it is not seen, not heard, or
// no nearer than `nearest`.
static double hear_corner(const model_t *const model, const scene_t *const scene, const view_t view,
                          const patch_t *const patch, const int32_t k, const double nearest) {
    double dx = patch->corner_x[k] - view.x, dy = patch->corner_y[k] - view.y;
    const double far = sqrt(dx * dx + dy * dy);
    const double along = dx * view.c + dy * view.s;
    if (!(along >= model->cos_half * far && far > 1.0 && far < model->no_echo_mm)) {
        return INFINITY;
    }
    dx /= far;
    dy /= far;
    const hit_t hit = cast_at_corner(scene, dx, dy, far, nearest, model->touch);
    const bool reached = hit.range >= far - 1.0;
    const double range = reached ? far : hit.range;
    if (range >= nearest) {
        return INFINITY;
    }
    double loss = surface_db(scene, hit, dx, dy);
    if (reached) {
        loss = fmin(loss, corner_loss_db(model, patch, k, dx, dy));
    }
    const double part = along / far;
    const double off = acos(part < 1.0 ? part : 1.0) * deg_per_rad * 2 / model->cone_deg;
    loss = loss + beam_db(model, off) + model->air_db_mm * range;
    return loss <= scene->margin_db ? range : INFINITY;
}

static void leave_out(scene_t *const scene, const double nearest) {
    scene->nearer = &scene->near[scene->count];
    scene->nearer_count = 0;
    for (int32_t k = 0; k < scene->count; k++) {
        scene->nearer[scene->nearer_count] = scene->near[k];
        scene->nearer_count += scene->near[k].least < nearest;
    }
}

static double hear_corners(const model_t *const model, const scene_t *const scene, const view_t view,
                           const part_t *const part, double nearest) {
    for (int32_t k = 0; k < part->corners; k++) {
        const int32_t corner = part->items != NULL ? part->items[part->segments + k] : k;
        nearest = fmin(nearest, hear_corner(model, scene, view, part->patch, corner, nearest));
    }
    return nearest;
}

static int32_t heard_mm(echo_t *const self, const part_t *const still, const part_t *const others,
                        const view_t view, const double gain_db) {
    const model_t *const model = &self->model;
    const patch_t *const first = still->patch->segments > 0 ? still->patch : others->patch;
    if (first->segments <= 0) {
        return (int32_t)model->no_echo_mm;
    }
    if (!reserve(self, 2 * (still->segments + others->segments + 1))) {
        return NO_MEMORY;
    }
    int32_t count = gather(self->near, model->cos_half, still, view);
    count += gather(&self->near[count], model->cos_half, others, view);
    scene_t scene = {self->near, NULL, count, 0, relative(first, 0, view), model->margin_db + gain_db};
    double nearest = hear_fan(model, &scene, view, INFINITY);
    leave_out(&scene, nearest);
    nearest = hear_corners(model, &scene, view, still, nearest);
    nearest = hear_corners(model, &scene, view, others, nearest);
    return (int32_t)fmin(model->no_echo_mm, fmax(model->min_mm, rint(nearest)));
}

int32_t argus_sim_echo_range(echo_t *const self, const double x, const double y, const double heading_deg,
                             const double gain_db, const patch_t *const others) {
    static const patch_t none = {0};
    const double cell_mm = self->model.cell_mm;
    const int32_t column = (int32_t)floor(x / cell_mm), row = (int32_t)floor(y / cell_mm);
    const slot_t *const slot = slot_of(self->slots, self->capacity, column, row);
    if (slot->patch == NULL) {
        return UNKNOWN_CELL;
    }
    const part_t still = part_of(&self->model, slot, heading_deg);
    if (still.patch == NULL) {
        return NO_MEMORY;
    }
    const patch_t *const all = others != NULL ? others : &none;
    const part_t moving = {all, NULL, all->segments, all->corners};
    const double heading = heading_deg * rad_per_deg;
    return heard_mm(self, &still, &moving, (view_t){x, y, cos(heading), sin(heading)}, gain_db);
}

int32_t argus_sim_echo_ping(echo_t *const self, const int32_t sonar, const double x, const double y,
                            const double heading_deg, const double angle_deg, const double gain_db,
                            const patch_t *const others) {
    const double *const mount = &self->model.mount[3 * sonar];
    const double heading = heading_deg * rad_per_deg, c = cos(heading), s = sin(heading);
    return argus_sim_echo_range(self, x + mount[0] * c - mount[1] * s, y + mount[0] * s + mount[1] * c,
                                heading_deg + mount[2] + angle_deg, gain_db, others);
}
