// first_hit.vert: proposed triangles (gpu/propose.c), already in clip space.
layout(location = 0) in vec2 place;
layout(location = 1) in int face_of_corner;
flat out int face_id;

void main()
{
    face_id = face_of_corner;
    gl_Position = vec4(place, 0.0, 1.0);
}
