//! Methods that are compared.

use hairline_published::sine_integral::SineIntegral;
use hairline_published::{Method, PublishedMethod, Structure};
use serde::Serialize;

hairline_image::listed! {
    /// A method with its switches: the talk's columns, the talk's exact sine integral, and ours.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum BenchMethod {
        /// Published, without anti-aliasing, by the hierarchy.
        PointBvh = "published, AA off, BVH";
        /// Published, without anti-aliasing, by lists for each triangle.
        PointLists = "published, AA off, per triangle";
        /// Published, with anti-aliasing, by the hierarchy.
        Filtered = "published, AA on, BVH";
        /// `Filtered` with the exact sine integral.
        FilteredExact = "published, AA on, BVH, exact Si";
        Ours = "ours";
    }
    fn name;
}

impl BenchMethod {
    /// Ours always has it.
    pub fn antialiasing(self) -> bool {
        !matches!(self, Self::PointBvh | Self::PointLists)
    }

    pub fn method(self) -> Method {
        let usual = PublishedMethod::default();
        let published = |switches| Method {
            published: Some(switches),
            ..Method::PUBLISHED
        };
        let point = PublishedMethod {
            anti_aliasing: false,
            ..usual
        };
        match self {
            Self::PointBvh => published(point),
            Self::PointLists => published(PublishedMethod {
                structure: Structure::TriangleLists,
                ..point
            }),
            Self::Filtered => Method::PUBLISHED,
            Self::FilteredExact => published(PublishedMethod {
                si: SineIntegral::Exact,
                ..usual
            }),
            Self::Ours => Method::default(),
        }
    }
}
