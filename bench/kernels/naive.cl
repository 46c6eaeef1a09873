// The one-light kernel as it is usually written: one work-item per pixel, float4 images, float3 maths, built-in pow and
// normalize. models.md section 2 with Lambert. Only here to be measured against.
#define ONE_OVER_PI 0.318309886f

constant sampler_t nearest = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP_TO_EDGE | CLK_FILTER_NEAREST;

kernel void shade_naive(read_only image2d_t normals, read_only image2d_t positions, read_only image2d_t albedos,
                        read_only image2d_t specular, write_only image2d_t result, const float4 eye,
                        const float4 to_light, const float4 irradiance) {
    const int2 at = (int2)(get_global_id(0), get_global_id(1));
    const float4 normal = read_imagef(normals, nearest, at);
    if (dot(normal.xyz, normal.xyz) < 1e-12f) {
        write_imagef(result, at, (float4)(0.0f));
        return;
    }
    const float3 n = normalize(normal.xyz);
    const float3 l = to_light.xyz;
    const float3 e = normalize(eye.xyz - read_imagef(positions, nearest, at).xyz);
    const float nl = dot(n, l);
    if (nl <= 0.0f) {
        write_imagef(result, at, (float4)(0.0f, 0.0f, 0.0f, 1.0f));
        return;
    }
    const float ne = max(dot(n, e), 1e-4f);
    const float3 h = normalize(l + e);
    const float nh = clamp(dot(n, h), 0.0f, 1.0f);
    const float eh = clamp(dot(e, h), 0.0f, 1.0f);
    const float3 albedo = read_imagef(albedos, nearest, at).xyz;
    const float4 f0_shininess = read_imagef(specular, nearest, at);
    const float3 f0 = f0_shininess.xyz;
    const float shininess = f0_shininess.w;
    const float3 fresnel = f0 + (1.0f - f0) * pow(2.0f, (-5.55473f * eh - 6.98316f) * eh);
    const float lobe = (0.0397436f * shininess + 0.0856832f) * pow(nh, shininess) / max(nl, ne);
    const float3 brdf = albedo * ONE_OVER_PI * (1.0f - f0) + lobe * fresnel;
    write_imagef(result, at, (float4)(brdf * irradiance.xyz * nl, 1.0f));
}
