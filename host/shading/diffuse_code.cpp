#include "host/shading/diffuse_code.h"

namespace clshade {

DiffuseCode diffuse_code(DiffuseModel model) {
    switch (model) {
    case DiffuseModel::none:
        return {"", "", "splat(0.0f)"};
    case DiffuseModel::lambert:
        return {"", "", "lambert(i)"};
    case DiffuseModel::oren_nayar:
        return {"oren_nayar_terms", "oren_nayar_terms_of", "oren_nayar(i, s, m.terms)"};
    case DiffuseModel::oren_nayar_full:
        return {"oren_nayar_full_terms", "oren_nayar_full_terms_of", "oren_nayar_full(i, s, m.terms)"};
    case DiffuseModel::oren_nayar_qualitative:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_qualitative(i, s, m.terms)"};
    case DiffuseModel::oren_nayar_simplified_1:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_simplified_1(i, s, m.terms)"};
    case DiffuseModel::oren_nayar_simplified_2:
        return {"oren_nayar_terms", "oren_nayar_qualitative_terms_of", "oren_nayar_simplified_2(i, s, m.terms)"};
    case DiffuseModel::oren_nayar_shininess:
        return {"oren_nayar_terms", "oren_nayar_shininess_terms_of", "oren_nayar_simplified_2(i, s, m.terms)"};
    }
    return {};
}

} // namespace clshade
