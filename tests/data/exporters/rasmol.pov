// File: ras.pov
// Creator: RasMol Version 2.7.6.0
// Version: POV-Ray Version 2.2

#include "shapes.inc"
#include "colors.inc"
#include "textures.inc"

// Camera
camera {    location <0, 0, -4.452>
    look_at <0, 0, 0>
}

// Light
light_source {<0, 20, -100> color rgb <1, 1, 1>}

// Objects
object {sphere {<-0.8, 0.488, -0.002> 1.548}
  texture {
    pigment {color rgb <0.784314, 0.784314, 0.784314>}
  }
}
object {sphere {<0.714, 0.481, -0.001> 1.548}
  texture {
    pigment {color rgb <0.784314, 0.784314, 0.784314>}
  }
}
object {sphere {<1.196, -0.783, -0.434> 1.348}
  texture {
    pigment {color rgb <0.941176, 0, 0>}
  }
}
object {sphere {<-1.185, 1.459, 0.32> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
object {sphere {<-1.192, -0.286, 0.666> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
object {sphere {<-1.186, 0.269, -1.004> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
object {sphere {<1.105, 0.681, 1.001> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
object {sphere {<1.101, 1.245, -0.681> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
object {sphere {<0.856, -1.453, 0.183> 1.1}
  texture {
    pigment {color rgb <1, 1, 1>}
  }
}
