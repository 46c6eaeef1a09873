#include "host/gbuffer/cryptomatte.h"

#include "host/base/error.h"
#include "host/base/suggest.h"
#include "host/gbuffer/channel_layers.h"
#include "host/gbuffer/find_named.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <utility>

namespace clshade {

namespace {

constexpr std::string_view known_hash = "MurmurHash3_32";
constexpr std::string_view known_conversion = "uint32_to_float32";

/// What messages call it.
std::string title_of(const Cryptomatte& cryptomatte) {
    return cryptomatte.name.empty() ? fmt::format("cryptomatte/{}", cryptomatte.key) : cryptomatte.name;
}

/// Without the view layer: "CryptoMaterial" of "View Layer.001.CryptoMaterial".
std::string_view short_name(const Cryptomatte& cryptomatte) {
    return std::string_view(cryptomatte.name).substr(cryptomatte.name.rfind('.') + 1);
}

/// Takes {"name": "id", ...} and stops at anything nested, so that no text, however hostile, costs more memory than a
/// few times its length.
class ManifestReader : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit ManifestReader(Cryptomatte& cryptomatte) : cryptomatte_(cryptomatte) {}

    bool null() override { return other(); }
    bool boolean(bool /*value*/) override { return other(); }
    bool number_integer(number_integer_t /*value*/) override { return other(); }
    bool number_unsigned(number_unsigned_t /*value*/) override { return other(); }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return other(); }
    bool binary(binary_t& /*value*/) override { return other(); }
    bool string(string_t& value) override { return take(std::move(value)); }
    bool key(string_t& value) override {
        name_ = std::move(value);
        return true;
    }
    bool start_object(std::size_t /*elements*/) override { return !std::exchange(inside_, true); }
    bool end_object() override { return true; }
    bool start_array(std::size_t /*elements*/) override { return false; }
    bool end_array() override { return false; }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        return false;
    }

  private:
    /// What is no text is no id; its digits must not pass for one.
    bool other() { return take("not a text"); }
    bool take(std::string id) {
        if (inside_) {
            cryptomatte_.manifest.insert_or_assign(std::move(name_), std::move(id));
        }
        return inside_;
    }

    Cryptomatte& cryptomatte_;
    std::string name_;
    bool inside_ = false;
};

void read_manifest(Cryptomatte& cryptomatte, const std::string& text) {
    ManifestReader reader(cryptomatte);
    if (!nlohmann::json::sax_parse(text, &reader)) {
        cryptomatte.manifest.clear(); // the rest cannot be trusted either
        cryptomatte.trouble = "its manifest is no JSON object of names and ids";
    }
}

/// All Cryptomattes that the attributes cryptomatte/<key>/<field> tell of, by key.
std::vector<Cryptomatte> read_all(const ImageLayout& layout) {
    constexpr std::string_view start = "cryptomatte/";
    std::map<std::string, std::map<std::string, const std::string*>> fields_by_key;
    for (const auto& [attribute, value] : layout.strings) {
        const std::size_t slash = attribute.find('/', start.size());
        if (attribute.starts_with(start) && slash != std::string::npos) {
            fields_by_key[attribute.substr(start.size(), slash - start.size())][attribute.substr(slash + 1)] = &value;
        }
    }
    std::vector<Cryptomatte> all;
    for (const auto& [key, fields] : fields_by_key) {
        const auto field = [&fields = fields](const char* name) {
            const auto found = fields.find(name);
            return found == fields.end() ? std::string() : *found->second;
        };
        Cryptomatte cryptomatte;
        cryptomatte.key = key;
        cryptomatte.name = field("name");
        cryptomatte.hash = field("hash");
        cryptomatte.conversion = field("conversion");
        if (const auto manifest = fields.find("manifest"); manifest != fields.end()) {
            read_manifest(cryptomatte, *manifest->second);
        } else if (const std::string sidecar = field("manif_file"); !sidecar.empty()) {
            cryptomatte.trouble = fmt::format("its manifest file '{}' was not read", sidecar);
        } else {
            cryptomatte.trouble = "it has no manifest";
        }
        all.push_back(std::move(cryptomatte));
    }
    return all;
}

/// Why the samples cannot hold ids bit by bit; empty if they can.
std::string why_inexact(const ImageLayout& layout, const ChannelInfo& channel) {
    if (channel.type != SampleType::float32) {
        return channel.type == SampleType::half ? "is stored as half, which destroys ids; write it as 32-bit float"
                                                : "holds whole numbers, not floats";
    }
    const std::size_t part = static_cast<std::size_t>(channel.part);
    const std::string compression = part < layout.parts.size() ? layout.parts[part].compression : "";
    // DWA goes by the last part of the name, upper case only.
    const std::string last = channel.file_name.substr(channel.file_name.rfind('.') + 1);
    const bool dwa = compression.starts_with("dwa") && (last == "R" || last == "G" || last == "B" || last == "Y");
    if (dwa || compression == "pxr24") {
        return fmt::format("is damaged by lossy {} compression; write it with zip", compression);
    }
    return {};
}

void check_method(const Cryptomatte& cryptomatte, const std::string& file, const std::string& what) {
    const auto check = [&](std::string_view field, const std::string& value, std::string_view known) {
        if (value != known) {
            throw UsageError(
                fmt::format("{}: Cryptomatte '{}' of {} has {} '{}', and only {} is known; use ids instead", what,
                            title_of(cryptomatte), file, field, value, known));
        }
    };
    check("hash", cryptomatte.hash, known_hash);
    check("conversion", cryptomatte.conversion, known_conversion);
}

} // namespace

std::uint32_t float_bits_of_id(std::uint32_t id) {
    const std::uint32_t exponent = (id >> 23U) & 0xffU;
    return exponent == 0U || exponent == 0xffU ? id ^ (1U << 23U) : id;
}

std::optional<std::uint32_t> parse_id(std::string_view text) {
    std::uint32_t id = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, id, 16);
    const bool whole = error == std::errc() && stop == end;
    return whole && text.size() == 8 ? std::optional(id) : std::nullopt;
}

/// A manifest that has the name, and what it has of it.
struct CryptomatteSet::Hit {
    const Cryptomatte* cryptomatte = nullptr;
    std::string name; ///< without a qualifier
    std::string id;
};

CryptomatteSet::CryptomatteSet(const ImageLayout& layout, std::string view)
    : layout_(&layout), view_(std::move(view)), all_(read_all(layout)) {}

std::vector<CryptomatteSet::Hit> CryptomatteSet::hits(const std::string& name) const {
    std::vector<Hit> plain;
    std::vector<Hit> qualified;
    for (const Cryptomatte& cryptomatte : all_) {
        if (const auto found = cryptomatte.manifest.find(name); found != cryptomatte.manifest.end()) {
            plain.push_back({&cryptomatte, name, found->second});
        }
        for (const std::string_view type : {std::string_view(cryptomatte.name), short_name(cryptomatte)}) {
            if (type.empty() || !name.starts_with(type) || name.substr(type.size(), 1) != "/") {
                continue;
            }
            const std::string rest = name.substr(type.size() + 1);
            if (const auto found = cryptomatte.manifest.find(rest); found != cryptomatte.manifest.end()) {
                qualified.push_back({&cryptomatte, rest, found->second});
                break; // both types are the same where there is no view layer
            }
        }
    }
    return plain.empty() ? qualified : plain;
}

CryptomatteSet::Found CryptomatteSet::find(const std::string& name, const std::string& what) const {
    const std::vector<Hit> found = hits(name);
    if (found.empty()) {
        throw_unknown(name, what);
    }
    if (found.size() > 1) {
        const auto same_type = [](const Hit& a, const Hit& b) {
            return short_name(*a.cryptomatte) == short_name(*b.cryptomatte);
        };
        std::vector<std::string> forms;
        for (const Hit& hit : found) {
            const bool unique =
                std::count_if(found.begin(), found.end(), [&](const Hit& other) { return same_type(hit, other); }) == 1;
            forms.push_back(
                fmt::format("\"{}/{}\"", unique ? short_name(*hit.cryptomatte) : title_of(*hit.cryptomatte), hit.name));
        }
        throw UsageError(fmt::format("{}: several Cryptomattes of {} have the name '{}'; write {}", what, layout_->file,
                                     name, fmt::join(forms, " or ")));
    }
    const Cryptomatte& cryptomatte = *found.front().cryptomatte;
    const std::optional<std::uint32_t> id = parse_id(found.front().id);
    if (!id) {
        throw UsageError(
            fmt::format("{}: the manifest of '{}' in {} gives '{}' the id '{}', which is not 8 hexadecimal "
                        "digits; render the file again or use ids instead",
                        what, title_of(cryptomatte), layout_->file, found.front().name, found.front().id));
    }
    check_method(cryptomatte, layout_->file, what);
    return {rank_0_channel(cryptomatte, what), float_bits_of_id(*id)};
}

int CryptomatteSet::rank_0_channel(const Cryptomatte& cryptomatte, const std::string& what) const {
    const std::string wanted = cryptomatte.name + "00";
    const std::vector<ChannelLayer> layers = visible_layers(*layout_, view_);
    std::vector<const ChannelLayer*> exact;
    std::vector<const ChannelLayer*> relative; // behind a view layer that the attribute does not tell of
    for (const ChannelLayer& layer : layers) {
        if (layer.name == wanted || layer.raw_name == wanted) {
            exact.push_back(&layer);
        } else if (prefix_before(layer.name, wanted, false)) {
            relative.push_back(&layer);
        }
    }
    const std::vector<const ChannelLayer*>& fits = exact.empty() ? relative : exact;
    const std::optional<int> channel =
        fits.size() == 1 && !cryptomatte.name.empty() ? component(*fits.front(), "R") : std::nullopt;
    if (fits.size() > 1) {
        throw UsageError(fmt::format("{}: the ids of Cryptomatte '{}' in {} may be {} or {}; leave one of them out",
                                     what, title_of(cryptomatte), layout_->file, fits[0]->name, fits[1]->name));
    }
    if (!channel) {
        throw UsageError(fmt::format("{}: {} has the manifest of Cryptomatte '{}' but not its ids (channel '{}.R' or "
                                     "'.r'); keep its layers in the file",
                                     what, layout_->file, title_of(cryptomatte), wanted));
    }
    const ChannelInfo& info = layout_->channels[static_cast<std::size_t>(*channel)];
    if (const std::string reason = why_inexact(*layout_, info); !reason.empty()) {
        throw UsageError(fmt::format("{}: Cryptomatte channel '{}' of {} {}", what, info.name, layout_->file, reason));
    }
    return *channel;
}

void CryptomatteSet::throw_unknown(const std::string& name, const std::string& what) const {
    if (all_.empty()) {
        throw UsageError(fmt::format("{}: {} has no Cryptomatte to look up '{}' in; render one, or use ids", what,
                                     layout_->file, name));
    }
    std::vector<std::string> names;
    std::vector<std::string> qualified;
    for (const Cryptomatte& cryptomatte : all_) {
        for (const auto& entry : cryptomatte.manifest) {
            names.push_back(entry.first);
            qualified.push_back(fmt::format("{}/{}", short_name(cryptomatte), entry.first));
        }
    }
    std::string hint = did_you_mean(name, std::span<const std::string>(names));
    if (hint.empty() && name.find('/') != std::string::npos) {
        hint = did_you_mean(name, std::span<const std::string>(qualified));
    }
    if (hint.empty() && !names.empty()) {
        hint = fmt::format("; it has {}", list_names(names));
    }
    for (const std::string& warning : warnings()) {
        hint += "; " + warning;
    }
    throw UsageError(
        fmt::format("{}: no Cryptomatte manifest of {} has the name '{}'{}", what, layout_->file, name, hint));
}

std::vector<std::string> CryptomatteSet::warnings() const {
    std::vector<std::string> lines;
    for (const Cryptomatte& cryptomatte : all_) {
        if (!cryptomatte.trouble.empty()) {
            lines.push_back(
                fmt::format("Cryptomatte '{}' cannot be used: {}", title_of(cryptomatte), cryptomatte.trouble));
        }
    }
    return lines;
}

std::vector<CryptomatteClaim> bind_claims(PlaneTable& table, const CryptomatteSet& cryptomattes,
                                          const Material& material) {
    std::vector<CryptomatteClaim> claims;
    for (const std::string& name : material.names) {
        const std::string what = located(material.names_where, fmt::format("material '{}', names", material.name));
        const CryptomatteSet::Found found = cryptomattes.find(name, what);
        CryptomatteClaim claim;
        claim.name = name;
        claim.plane = table.add(found.channel);
        claim.bits = found.bits;
        const bool known = std::any_of(claims.begin(), claims.end(), [&](const CryptomatteClaim& other) {
            return other.plane == claim.plane && other.bits == claim.bits;
        });
        if (!known) {
            claims.push_back(std::move(claim));
        }
    }
    return claims;
}

void refuse_shared_claims(std::span<const BoundMaterial> bound, std::span<const Material> materials) {
    struct Claimant {
        const BoundMaterial* material;
        const std::string* name;
    };
    std::map<std::pair<PlaneIndex, std::uint32_t>, Claimant> claimants;
    for (std::size_t i = 0; i < bound.size(); ++i) {
        for (const CryptomatteClaim& claim : bound[i].cryptomatte) {
            const auto [first, added] =
                claimants.try_emplace({claim.plane, claim.bits}, Claimant{&bound[i], &claim.name});
            if (added) {
                continue;
            }
            const std::string what =
                located(materials[i].names_where, fmt::format("material '{}', names", materials[i].name));
            throw UsageError(fmt::format(
                "{}: material '{}' claims the same Cryptomatte id by '{}' as '{}' does here; let one material have it",
                what, first->second.material->name, *first->second.name, claim.name));
        }
    }
}

} // namespace clshade
