//! Tests of the physics against quadrature and transforms that share none of its code. They are one
//! program, since linking each takes seconds.

mod coherent;
mod lobes;
