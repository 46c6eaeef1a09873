// Private to host/gbuffer: materials of the scene bound to planes.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/roles.h"
#include "host/scene/scene.h"

#include <map>
#include <vector>

namespace clshade {

/// The channels to be read, each once, in the order in which they were asked for.
class PlaneTable {
  public:
    /// Appends to `channels`, which must outlive the table.
    PlaneTable(const ImageLayout& layout, std::vector<int>& channels) : layout_(&layout), channels_(&channels) {}

    /// Plane of a channel (an index into layout.channels).
    PlaneIndex add(int channel) {
        const auto [place, added] = planes_.try_emplace(channel, static_cast<PlaneIndex>(channels_->size()));
        if (added) {
            channels_->push_back(channel);
        }
        return place->second;
    }
    [[nodiscard]] const ImageLayout& layout() const { return *layout_; }

  private:
    const ImageLayout* layout_;
    std::vector<int>* channels_;
    std::map<int, PlaneIndex> planes_;
};

/// The planes of a role as a parameter.
[[nodiscard]] BoundParameter bind_role(PlaneTable& table, const RoleChoice& choice,
                                       Conversion convert = Conversion::none);

/// Binds the parameters that the material's models use; the others stay constants of 0. `automatic` parameters are
/// taken from the roles the file has. Throws UsageError naming the material and parameter.
[[nodiscard]] BoundMaterial bind_material(PlaneTable& table, const RoleAssignment& roles, const Material& material,
                                          const AutomaticParameters& automatic);

} // namespace clshade
