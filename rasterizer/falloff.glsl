// How what lies within a radius counts over its distance: Falloff of frames/quantities.h.
//
// Defines: FALLOFF with the names of its values.

// Of the squared distance over the squared radius.
float falloff(float relative_square) {
#if FALLOFF == HARD
    return relative_square < 1.0 ? 1.0 : 0.0;
#elif FALLOFF == QUADRATIC
    return max(0.0, 1.0 - relative_square);
#elif FALLOFF == CUBIC
    float quadratic = max(0.0, 1.0 - relative_square);
    return quadratic * quadratic * quadratic;
#endif
}
