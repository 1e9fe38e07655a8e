// The built-in OpenColorIO configuration, used unless $OCIO is set. Its reference space is scene-linear Rec.709, as in
// libretex. OpenColorIO 2.1 has no built-in configuration, and pictures must be the same on every machine. The curves
// of Filmic and Neutral precede that of sRGB: picture/view.h computes them.
#include "bridge.hpp"

namespace bridge
{

const char *const own_configuration = R"yaml(ocio_profile_version: 2

environment: {}
search_path: ""
strictparsing: true
luma: [0.2126, 0.7152, 0.0722]
description: retex - scene-linear Rec.709 in the middle, plain sRGB to look at

roles:
  default: Linear Rec.709
  reference: Linear Rec.709
  scene_linear: Linear Rec.709
  rendering: Linear Rec.709
  compositing_linear: Linear Rec.709
  aces_interchange: ACES2065-1
  color_timing: ACEScct
  compositing_log: ACEScct
  color_picking: sRGB
  texture_paint: sRGB
  matte_paint: sRGB
  data: raw

file_rules:
  - !<Rule> {name: Default, colorspace: default}

displays:
  sRGB:
    - !<View> {name: Standard, colorspace: sRGB}
    - !<View> {name: Filmic, colorspace: sRGB}
    - !<View> {name: Neutral, colorspace: sRGB}
    - !<View> {name: Raw, colorspace: raw}

active_displays: [sRGB]
active_views: [Standard, Filmic, Neutral, Raw]

colorspaces:
  - !<ColorSpace>
    name: Linear Rec.709
    aliases: [linear, lin_rec709_scene, lin_rec709, lin_srgb, lin_rec709_srgb,
      "Linear Rec.709 (sRGB)", "Utility - Linear - sRGB"]
    family: scene-linear
    bitdepth: 32f
    description: Scene-linear, Rec.709 primaries, D65 white
    encoding: scene-linear
    isdata: false
    allocation: lg2
    allocationvars: [-8, 5, 0.00390625]

  - !<ColorSpace>
    name: sRGB
    aliases: [srgb, srgb_rec709_scene, srgb_tx, srgb_texture,
      "sRGB - Texture", "Utility - sRGB - Texture", "sRGB Encoded Rec.709 (sRGB)"]
    family: display
    bitdepth: 8ui
    description: IEC 61966-2-1, the piecewise curve
    encoding: sdr-video
    isdata: false
    allocation: uniform
    to_scene_reference: !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: forward}

  - !<ColorSpace>
    name: Rec709
    aliases: [rec709, "Rec.709", "Camera Rec.709", "Utility - Rec.709 - Camera"]
    family: camera
    bitdepth: 8ui
    description: Video, ITU-R BT.709 camera curve
    encoding: sdr-video
    isdata: false
    allocation: uniform
    to_scene_reference: !<ExponentWithLinearTransform> {gamma: 2.22222222222222, offset: 0.099, direction: forward}

  - !<ColorSpace>
    name: ACES2065-1
    aliases: [aces2065_1, lin_ap0_scene, lin_ap0, "ACES - ACES2065-1"]
    family: ACES
    bitdepth: 32f
    description: Scene-linear, ACES AP0 primaries
    encoding: scene-linear
    isdata: false
    allocation: lg2
    allocationvars: [-8, 5, 0.00390625]
    to_scene_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1, direction: inverse}
        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD}

  - !<ColorSpace>
    name: ACEScg
    aliases: [acescg, lin_ap1_scene, lin_ap1, "ACES - ACEScg"]
    family: ACES
    bitdepth: 32f
    description: Scene-linear, ACES AP1 primaries
    encoding: scene-linear
    isdata: false
    allocation: lg2
    allocationvars: [-8, 5, 0.00390625]
    to_scene_reference: !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD}

  - !<ColorSpace>
    name: ACEScct
    aliases: [acescct, "ocio:acescct_ap1_scene", "ACES - ACEScct"]
    family: ACES
    bitdepth: 32f
    description: Logarithmic with a toe, ACES AP1 primaries
    encoding: log
    isdata: false
    allocation: uniform
    to_scene_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: ACEScct_to_ACES2065-1}
        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1, direction: inverse}
        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD}

  - !<ColorSpace>
    name: raw
    aliases: [none, "Utility - Raw"]
    family: data
    bitdepth: 32f
    description: Numbers that are no colors; nothing is done to them
    isdata: true
    allocation: uniform
)yaml";

} // namespace bridge
