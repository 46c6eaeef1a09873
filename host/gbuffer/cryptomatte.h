// Private to host/gbuffer: Cryptomatte names (Psyop's specification, version 1.2) looked up in the header's manifests.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/image_layout.h"
#include "host/gbuffer/parameter_binding.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// The float that stands for an id, as bits. Its exponent is never 0 or 255 (zero, denormal, infinite, NaN): there bit
/// 23 is flipped. Manifests hold the id before or after that (Blender: before).
[[nodiscard]] std::uint32_t float_bits_of_id(std::uint32_t id);

/// The id in a manifest: exactly 8 hexadecimal digits.
[[nodiscard]] std::optional<std::uint32_t> parse_id(std::string_view text);

/// What the attributes cryptomatte/<key>/... say.
struct Cryptomatte {
    std::string key;        ///< seven hexadecimal digits of the name's hash
    std::string name;       ///< of its layers without the rank: "ViewLayer.CryptoMaterial"
    std::string hash;       ///< "MurmurHash3_32"
    std::string conversion; ///< "uint32_to_float32"
    std::map<std::string, std::string, std::less<>> manifest; ///< ids by name, as written
    std::string trouble;                                      ///< why there is no manifest; empty if there is one
};

/// The Cryptomattes of a file. Damaged ones are an error only for a name that may have been in them.
class CryptomatteSet {
  public:
    /// `view`: the stereo view whose channels are meant. The layout must outlive the set.
    CryptomatteSet(const ImageLayout& layout, std::string view);

    struct Found {
        int channel = 0; ///< rank 0 ids: index into ImageLayout::channels
        std::uint32_t bits = 0;
    };
    /// Looks up a name: exactly as some manifest has it, or "CryptoMaterial/gold" and "ViewLayer.CryptoMaterial/gold"
    /// where no manifest has it as a whole. Throws UsageError starting with `what` if no manifest has the name (with
    /// near matches), several have it (with the qualified names), its id is damaged, or the ids are not in the file as
    /// whole floats by the one hash there is.
    [[nodiscard]] Found find(const std::string& name, const std::string& what) const;

    [[nodiscard]] const std::vector<Cryptomatte>& all() const { return all_; }
    /// One line for each manifest that cannot be read.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    struct Hit;
    [[nodiscard]] std::vector<Hit> hits(const std::string& name) const;
    [[nodiscard]] int rank_0_channel(const Cryptomatte& cryptomatte, const std::string& what) const;
    [[noreturn]] void throw_unknown(const std::string& name, const std::string& what) const;

    const ImageLayout* layout_;
    std::string view_;
    std::vector<Cryptomatte> all_;
};

/// Claims of a material's Cryptomatte names, each once; their planes join the table. Throws UsageError as `find`.
[[nodiscard]] std::vector<CryptomatteClaim> bind_claims(PlaneTable& table, const CryptomatteSet& cryptomattes,
                                                        const Material& material);

/// Throws UsageError if two of the materials, bound in the order of the scene's, claim the same id of one plane.
void refuse_shared_claims(std::span<const BoundMaterial> bound, std::span<const Material> materials);

} // namespace clshade
