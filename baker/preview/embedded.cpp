#include "baker/preview/embedded.h"

#define FT_EMBEDDED(name)                                                                                 \
  extern "C" const char ft_embedded_##name[], ft_embedded_##name##_end[];                                 \
  std::string_view ft::embedded_##name() {                                                                \
    return {ft_embedded_##name, static_cast<std::size_t>(ft_embedded_##name##_end - ft_embedded_##name)}; \
  }

FT_EMBEDDED(page)
FT_EMBEDDED(style)
FT_EMBEDDED(plots)
FT_EMBEDDED(paths)
FT_EMBEDDED(instances)
FT_EMBEDDED(curves)
FT_EMBEDDED(points)
FT_EMBEDDED(wind)
FT_EMBEDDED(water)
FT_EMBEDDED(player)
FT_EMBEDDED(three)
FT_EMBEDDED(controls)
