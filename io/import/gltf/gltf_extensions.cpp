#include "io/import/gltf/gltf_extensions.h"

#include <string_view>

namespace ft::inline io::gltf {

ExtensionUse extension_use(const std::string& name) {
  for (const char* known : {"KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
                            "KHR_meshopt_compression", "KHR_animation_pointer", "KHR_node_visibility"})
    if (name == known) return ExtensionUse::k_read;
  for (const char* known :
       {"EXT_mesh_gpu_instancing", "VRMC_node_constraint", "VRMC_springBone", "KHR_physics_rigid_bodies",
        "KHR_implicit_shapes", "MSFT_physics", "KHR_gaussian_splatting", "KHR_interactivity", "OMI_physics_body",
        "OMI_physics_joint", "ADOBE_physics", "EXT_mesh_manifold_indices"})
    if (name == known) return ExtensionUse::k_not_used;
  for (const std::string_view start : {"KHR_materials_",
                                       "EXT_materials_",
                                       "KHR_texture_",
                                       "EXT_texture_",
                                       "MSFT_texture_",
                                       "GOOGLE_texture_",
                                       "KHR_lights_",
                                       "EXT_lights_",
                                       "KHR_technique",
                                       "KHR_xmp",
                                       "KHR_audio",
                                       "MSFT_audio",
                                       "MSFT_packing_",
                                       "MSFT_lod",
                                       "AGI_",
                                       "CESIUM_",
                                       "EXT_structural_metadata",
                                       "EXT_mesh_features",
                                       "EXT_instance_features",
                                       "EXT_feature_metadata",
                                       "EXT_mesh_primitive_edge_visibility",
                                       "FB_geometry_metadata",
                                       "ADOBE_materials_",
                                       "MOZ_lightmap",
                                       "MPEG_texture_",
                                       "NV_materials_",
                                       "KHR_node_selectability",
                                       "KHR_node_hoverability",
                                       "KHR_environment_map",
                                       "VRMC_materials_",
                                       "VRMC_vrm",
                                       "OMI_audio",
                                       "OMI_link",
                                       "KHR_binary_glTF"})
    if (name.starts_with(start)) return ExtensionUse::k_appearance;
  if (name == "VRM") return ExtensionUse::k_appearance;  // of version 0: a list of bones, expressions and springs
  return ExtensionUse::k_unknown;
}

}  // namespace ft::inline io::gltf
