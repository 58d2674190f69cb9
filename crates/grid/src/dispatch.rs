//! Run-time choice of wider instructions for inner loops.

use puncta_core::Record;
use wide::f32x4;

/// How many bytes ahead streams are prefetched.
pub(crate) const STREAM_AHEAD: usize = 4096;

/// A loop that is worth compiling for wider instructions.
pub(crate) trait Kernel {
    /// What it computes.
    type Output;

    /// Runs the loop. Implementations must always be inlined, and so must what they call.
    fn run(self) -> Self::Output;
}

/// Runs a kernel, compiled for AVX2 where the machine has it.
#[inline]
pub(crate) fn widest<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,bmi1,bmi2")]
        fn run<K: Kernel>(kernel: K) -> K::Output {
            kernel.run()
        }
        if std::arch::is_x86_feature_detected!("avx2")
            && std::arch::is_x86_feature_detected!("bmi1")
            && std::arch::is_x86_feature_detected!("bmi2")
        {
            #[expect(unsafe_code, reason = "the features were detected just now")]
            // SAFETY: the processor has all the features that the function is compiled for.
            return unsafe { run(kernel) };
        }
    }
    kernel.run()
}

/// Asks for what lies `bytes` behind these values, without waiting for it.
#[inline(always)]
pub(crate) fn prefetch<T>(values: &[T], bytes: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in (0..size_of_val(values)).step_by(64) {
            let ahead = values.as_ptr().wrapping_byte_add(bytes + line);
            #[expect(unsafe_code, reason = "the intrinsic takes a pointer")]
            // SAFETY: a prefetch reads nothing, wherever it points.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(ahead.cast());
            }
        }
    }
}

/// The position of a record and its radius.
#[inline(always)]
pub(crate) fn lanes_of<R: Record>(record: &R) -> f32x4 {
    let position = record.position();
    f32x4::new([position.x, position.y, position.z, record.radius()])
}
