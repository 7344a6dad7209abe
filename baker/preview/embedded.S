/* Bytes of the files named by the build (FT_..._FILE), between two labels each. */
.section .rodata
.macro embed name, file
  .global ft_embedded_\name
  ft_embedded_\name:
  .incbin "\file"
  .global ft_embedded_\name\()_end
  ft_embedded_\name\()_end:
  .byte 0
.endm
embed page, FT_PAGE_FILE
embed style, FT_STYLE_FILE
embed plots, FT_PLOTS_FILE
embed paths, FT_PATHS_FILE
embed instances, FT_INSTANCES_FILE
embed curves, FT_CURVES_FILE
embed points, FT_POINTS_FILE
embed wind, FT_WIND_FILE
embed water, FT_WATER_FILE
embed player, FT_PLAYER_FILE
embed three, FT_THREE_FILE
embed controls, FT_CONTROLS_FILE
.section .note.GNU-stack, "", @progbits
