#include "host/demo/demo_gbuffer.h"

namespace clshade {

std::string demo_scene_toml() {
    return R"(# The scene of `clshade demo`. Z is up, the camera stands on the -Y side; units are metres.
# The camera itself is in the headers of the EXR files (worldToCamera, worldToNDC).
version = 1

[environment]
image = "studio.exr"                # lat-long: soft boxes in a dark room; any .hdr or .exr will do
up = "z"
rotation_degrees = -90.0            # the middle of the picture stands behind the camera
intensity = 0.7

[output]
background = true                   # the room itself where there is no object

[[light]]
name = "key"                        # over the left shoulder, warm, where the studio has its large soft box
type = "distant"
direction = [0.55, 0.62, -0.75]     # the way the light travels
irradiance = 0.8
color = [1.0, 0.95, 0.87]

[[light]]
name = "pool"                       # a spot on the middle of the stage
type = "spot"
position = [1.6, -3.6, 6.5]
direction = [-0.22, 0.52, -0.90]
intensity = 30.0                    # irradiance = intensity / distance^2
color = [1.0, 0.90, 0.72]
cone_angle_degrees = 26.0
cone_softness = 0.55

[[light]]
name = "lamp_left"                  # two lamps behind the plinth draw the edges
type = "point"
position = [-4.2, 3.2, 2.6]
intensity = 14.0
color = [0.35, 0.62, 1.0]

[[light]]
name = "lamp_right"
type = "point"
position = [4.4, 2.8, 2.2]
intensity = 12.0
color = [1.0, 0.45, 0.25]

# Channels are named by role: albedo, f0, roughness. ggx_roughness turns a roughness map into a shininess.
[material.default]
specular = { model = "blinn_phong", f0 = "f0", shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse = { model = "lambert", albedo = "albedo" }

[material.stage]
ids = [1]
specular = { model = "blinn_phong", f0 = "f0", shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse = { model = "oren_nayar", albedo = "albedo" }      # one map drives both lobes

[material.letters]
ids = [3]
specular = { model = "blinn_phong_exact", f0 = "f0", shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse = { model = "lambert", albedo = "albedo" }

[material.metals]
ids = [5, 6, 10]                    # gold, copper, steel
specular = { model = "blinn_phong_exact", f0 = "f0", shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse = { model = "lambert", albedo = "albedo" }

[material.car_paint]
ids = [7]
specular = { model = "blinn_phong", ior = 1.6, shininess = 900 }
diffuse = { model = "lambert", albedo = "albedo" }

[material.chalk]
ids = [8]
diffuse = { model = "oren_nayar", albedo = "albedo", shininess = 3.0 }

[material.rubber]
ids = [9]
specular = { model = "blinn_phong_exact", f0 = 0.04, shininess = { channel = "roughness", convert = "ggx_roughness" } }
diffuse = { model = "oren_nayar", albedo = "albedo", shininess = 12.0 }
)";
}

} // namespace clshade
