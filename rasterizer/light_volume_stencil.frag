// Writes nothing but the stencil.
flat in int light;

void main() {}
