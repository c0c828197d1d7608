// A world as Foxglove's SceneUpdate, which its 3D panel draws: robots, ball, and once the field.
#ifndef VSSS_CLI_MCAP_SCENE_H
#define VSSS_CLI_MCAP_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/world.h"

#define MCAP_SCENE_SCHEMA_NAME "foxglove.SceneUpdate"
#define MCAP_SCENE_JSON_MAX    8192
extern const char mcap_scene_schema[]; // JSON Schema of what is written here, by the names that Foxglove documents

// One message. world: all its numbers finite. with_field: also floor and goals, which stay until they are replaced.
void mcap_scene(const vs_world *world, uint64_t time_ns, bool with_field, char out[MCAP_SCENE_JSON_MAX]);

#endif
