// ray_uniforms.glsl: what all rays of a picture have in common (tc_frame_build).
uniform dvec3 ray_point, ray_point_dx, ray_point_dy;             // affine in the pixel
uniform dvec3 ray_direction, ray_direction_dx, ray_direction_dy; // not normalised
uniform vec3 ray_up;
uniform vec2 ray_part; // the left lower pixel in the whole picture, of which these are: whole numbers, as floats exact
