//! The physics against quadrature and transforms that share none of its code.
//! In one program, since each that is linked takes seconds.

mod coherent;
mod lobes;
