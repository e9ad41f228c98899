//! Every struct that host and shader share, once. Twin: `shaders/scene/layout.wgsl`, which documents the members; the test
//! below holds names, offsets and sizes equal by naga's reflection of the text.
//!
//! Not encase: it writes structs member by member, where arrays of millions of these are copied as they lie in memory.

use bytemuck::{Pod, Zeroable};

/// [`Frame::environment_flags`]: there is an environment.
pub(crate) const ENVIRONMENT_PRESENT: u32 = 1;
/// [`Frame::environment_flags`]: the camera sees it.
pub(crate) const ENVIRONMENT_VISIBLE: u32 = 2;
/// The highest bit of [`Vertex::material`]: the bitangent is minus the cross product of normal and tangent.
pub(crate) const VERTEX_BITANGENT_FLIPPED: u32 = 0x8000_0000;

/// Offset of the pixels of a film in its buffer, bytes. A count comes first: invocations whose loops were cut short.
pub(crate) const FILM_PIXELS_OFFSET: u64 = 16;

/// Name, size, and name and offset of each member.
#[cfg(test)]
type HostStruct = (&'static str, usize, Vec<(&'static str, usize)>);

macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident { $($member:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
            #[allow(missing_docs, reason = "documented in layout.wgsl")]
            pub(crate) struct $name {
                $(pub $member: $type,)*
            }
        )*

        /// Every struct.
        #[cfg(test)]
        fn host_structs() -> Vec<HostStruct> {
            vec![$((
                stringify!($name),
                size_of::<$name>(),
                vec![$((stringify!($member), std::mem::offset_of!($name, $member))),*],
            )),*]
        }
    };
}

/// Layout of a struct that another crate has.
#[cfg(test)]
macro_rules! of_image {
    ($name:ident { $($member:ident),* }) => {{
        use hairline_image::$name;
        let offsets = vec![$((stringify!($member), std::mem::offset_of!($name, $member))),*];
        (stringify!($name), size_of::<$name>(), offsets)
    }};
}

// A member whose name begins with `pad` is room that WGSL leaves without a name.
shared! {
    /// The view of one sample; uniform.
    Frame {
        camera_m: [f32; 3],
        pad_0: f32,
        forward: [f32; 3],
        near_m: f32,
        per_px_x: [f32; 3],
        px_per_slope: f32,
        per_px_y: [f32; 3],
        footprint_std_px: f32,
        size_px: [u32; 2],
        rows: [u32; 2],
        jitter_px: [f32; 2],
        light_count: u32,
        environment_flags: u32,
        environment_from_world: [[f32; 4]; 3],
        environment_texel_radiance: f32,
        step: u32,
        sample: u32,
        samples: u32,
        film_row: u32,
        segment_count: u32,
        list_std_px: f32,
        list_jitter_px: f32,
        entry_count: u32,
        object_count: u32,
        group_count: u32,
        base_light_count: u32,
        middle_px: [f32; 2],
        coverage_round: u32,
        display_gain: f32,
        sample_order: [u32; 2],
        has_rays: u32,
        pad_1: u32,
    }
    /// A corner of a triangle.
    Vertex {
        position_m: [f32; 3],
        material: u32,
        normal: [f32; 3],
        u: f32,
        tangent: [f32; 3],
        v: f32,
        other_uv: [f32; 2],
        color: [u32; 2],
    }
    /// The scratches of an object, and its gratings.
    Object {
        first_segment: u32,
        end_segment: u32,
        first_node: u32,
        end_node: u32,
        depth_coherence: f32,
        coherence_um: f32,
        first_grating: u32,
        end_grating: u32,
    }
    /// Grooves side by side.
    Grating {
        axis: [f32; 3],
        kind: u32,
        center_m: [f32; 3],
        curvature_per_m: f32,
        radii_m: [f32; 2],
        coverage: f32,
        angle_std_rad: f32,
        material: u32,
        table: u32,
        seed: u32,
        pitch_um: f32,
        width_um: f32,
        jitter_pitches: f32,
        densest: f32,
        maps: u32,
        tiles_x: [f32; 4],
        tiles_y: [f32; 4],
        tiles_z: [f32; 4],
        mask: [u32; 2],
        directions: [u32; 2],
        along_row: [f32; 3],
        spacing_m: f32,
    }
    /// A material.
    Material {
        base_color: [f32; 3],
        metallic: f32,
        emission: [f32; 3],
        roughness: f32,
        coherence_um: f32,
        dielectric_f0: f32,
        normal_scale: f32,
        table: u32,
        curve: u32,
        is_unlit: u32,
        base_color_texture: [u32; 2],
        metallic_roughness_texture: [u32; 2],
        normal_texture: [u32; 2],
        emission_texture: [u32; 2],
        alpha: f32,
        threshold: f32,
        occlusion_texture: [u32; 2],
        occlusion_strength: f32,
        coat: u32,
        coat_texture: [u32; 2],
        coat_roughness_texture: [u32; 2],
        anisotropy: f32,
        anisotropy_direction_rad: f32,
        anisotropy_texture: [u32; 2],
        specular_color: [f32; 3],
        specular: f32,
        specular_texture: [u32; 2],
        specular_color_texture: [u32; 2],
        coat_normal_texture: [u32; 2],
        coat_normal_scale: f32,
        pad_0: u32,
    }
    /// A light.
    Light {
        radiance: [f32; 3],
        kind: u32,
        center_m: [f32; 3],
        radius_m: f32,
        normal: [f32; 3],
        two_sided: u32,
        first_vertex: u32,
        vertex_count: u32,
        cone: [f32; 2],
        cone_axis: [f32; 3],
        extras: u32,
    }
    /// A node over the segments of an object.
    ScratchNode {
        min_m: [f32; 3],
        skip: u32,
        max_m: [f32; 3],
        leaf: u32,
    }
    /// A straight piece of a scratch.
    ScratchSegment {
        start_m: [f32; 3],
        width_depth: u32,
        end_m: [f32; 3],
        normal_blur: u32,
    }
    /// The surface point that a pixel sees.
    PixelPoint {
        position_m: [f32; 3],
        object: u32,
        normal: [f32; 3],
        depth_m: f32,
        axis_x: [f32; 3],
        coherence_um: f32,
        footprint_um: [f32; 4],
        turns: [f32; 4],
        cos_o: f32,
        distance_m: f32,
        table_and_place: u32,
        leaves: f32,
    }
    /// The material of a sample's surface.
    PixelPaint {
        f0: [f32; 3],
        lobe: u32,
        diffuse: [u32; 2],
        coat: u32,
        triangle: u32,
        emission: [u32; 3],
        curve_bits: u32,
    }
    /// Radiance of the base.
    BaseLight {
        specular: [f32; 3],
        emission_red: f32,
        body: [f32; 3],
        emission_green: f32,
        fresnel: [f32; 3],
        emission_blue: f32,
    }
    /// Sums over the segments of a chunk, for one pixel.
    ChunkSum {
        radiance: [f32; 3],
        share: f32,
        energy: [f32; 3],
        share_by_line: f32,
    }
    /// The lights of one dispatch; uniform.
    LightRange {
        first: u32,
        end: u32,
        adds: u32,
    }
    /// One round of rays to one source; uniform.
    ShadowRound {
        source: u32,
        round: u32,
        rounds: u32,
        extent_m: f32,
        first_round: u32,
        all_rounds: u32,
        ends_round: u32,
        first_pick: u32,
        picks: u32,
        seed: u32,
        depth: u32,
        way: u32,
    }
    /// A ray from a sample to a source.
    ShadowRay {
        direction: [f32; 3],
        distance_m: f32,
        specular: [f32; 3],
        offset_x: f32,
        body: [f32; 3],
        offset_y: f32,
    }
    /// Light that rays found in a layer of a sample.
    FoundRays {
        weight: [f32; 3],
        round_weight: f32,
        seen: [f32; 3],
        round_seen: f32,
        bounced: [f32; 3],
        round_bounced: f32,
        around: [f32; 3],
        pad_0: f32,
        open: [f32; 3],
        pad_1: f32,
        share_moments: [f32; 2],
        bounced_moments: [f32; 2],
    }
    /// A ray from a sample to other objects.
    BounceRay {
        direction: [f32; 3],
        distance_m: f32,
        throughput: [f32; 3],
        solid_angle_sr: f32,
        specular: [f32; 3],
        triangle: u32,
        body: [f32; 3],
        object: u32,
        place: [f32; 2],
        pad_0: [f32; 2],
    }
    /// Sums over the samples of a pixel.
    FilmPixel {
        base: [f32; 3],
        depth_m: f32,
        scratches: [f32; 3],
        coverage: f32,
        density: [f32; 3],
        samples: u32,
        normal: [f32; 3],
        edge: u32,
        luminance: f32,
        compressed: f32,
        display_gain: f32,
        pad_0: f32,
    }
    /// A pass of the radix sort; uniform.
    SortSettings {
        shift: u32,
        block_count: u32,
    }
    /// A scan; uniform.
    ScanSettings {
        count: u32,
    }
    /// Settings of a dispatch of the filter; uniform.
    FilterSettings {
        size_px: [u32; 2],
        first_row: u32,
        rows: u32,
        step: u32,
        rounds: u32,
        layer: u32,
        noise_std: f32,
        off_plane: f32,
        normal_power: f32,
        rough_normals: f32,
        outline_px: i32,
        mirror_step_px: f32,
        rough_step_px: f32,
        variance_px: i32,
        outlier_std: f32,
        least_around: f32,
        least_alike: f32,
    }
    /// Settings for showing a film; uniform.
    DisplaySettings {
        size_px: [u32; 2],
        tone_map: u32,
        gain: f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders;
    use naga::{Module, TypeInner};

    /// Structs of this crate and those that a film holds for another one.
    fn all_host_structs() -> Vec<HostStruct> {
        let mut all = host_structs();
        all.push(of_image!(FoundLight {
            open,
            around,
            weight,
            seen,
            bounced,
            share_moments,
            bounced_moments
        }));
        all.push(of_image!(FoundPixel {
            rest,
            roughness,
            object,
            diffuse,
            specular,
            scratches
        }));
        all
    }

    fn reflect() -> Module {
        let text = shaders::compose(&[&shaders::LAYOUT]);
        naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)))
    }

    fn wgsl_struct<'a>(module: &'a Module, name: &str) -> Option<(&'a [naga::StructMember], u32)> {
        module.types.iter().find_map(|(_, ty)| match &ty.inner {
            TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
                Some((members.as_slice(), *span))
            }
            _ => None,
        })
    }

    /// Describes the difference of a host struct from the shader's, if there is one.
    fn difference(
        module: &Module,
        name: &str,
        size: usize,
        members: &[(&str, usize)],
    ) -> Option<String> {
        let Some((shader_members, shader_size)) = wgsl_struct(module, name) else {
            return Some(format!("layout.wgsl has no struct {name}"));
        };
        if shader_size as usize != size {
            return Some(format!(
                "{name}: {size} bytes on the host, {shader_size} in the shader"
            ));
        }
        let host: Vec<_> = members
            .iter()
            .filter(|(member, _)| !member.starts_with("pad"))
            .copied()
            .collect();
        let shader: Vec<_> = shader_members
            .iter()
            .map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize))
            .collect();
        (host != shader).then(|| format!("{name}:\n  host   {host:?}\n  shader {shader:?}"))
    }

    #[test]
    fn host_and_shader_structs_are_equal() {
        let module = reflect();
        let differences: Vec<_> = all_host_structs()
            .iter()
            .filter_map(|(name, size, members)| difference(&module, name, *size, members))
            .collect();
        assert!(differences.is_empty(), "{}", differences.join("\n"));
    }

    /// The comparison must be able to fail: a renamed member, a swapped pair, another size.
    #[test]
    fn a_drifted_struct_is_seen() {
        let module = reflect();
        let right = [("first", 0), ("end", 4), ("adds", 8)];
        assert_eq!(difference(&module, "LightRange", 12, &right), None);
        assert!(difference(&module, "LightRange", 16, &right).is_some());
        let renamed = [("start", 0), ("end", 4), ("adds", 8)];
        assert!(difference(&module, "LightRange", 12, &renamed).is_some());
        let swapped = [("end", 0), ("first", 4), ("adds", 8)];
        assert!(difference(&module, "LightRange", 12, &swapped).is_some());
    }

    /// Every struct of the shader has its host twin, and array strides are the structs' sizes.
    #[test]
    fn no_shader_struct_is_left_out() {
        let module = reflect();
        let host = all_host_structs();
        for (_, ty) in module.types.iter() {
            let name = ty.name.as_deref().unwrap_or("");
            if let TypeInner::Struct { members, .. } = &ty.inner {
                let known = host.iter().any(|(known, ..)| *known == name);
                // An array without an end follows its head.
                if name == "Film" {
                    assert_eq!(u64::from(members[1].offset), FILM_PIXELS_OFFSET);
                } else {
                    assert!(known, "{name} has no host twin");
                }
            }
            if let TypeInner::Array { base, stride, .. } = ty.inner
                && let Some((_, size, _)) = host
                    .iter()
                    .find(|(n, ..)| module.types[base].name.as_deref() == Some(n))
            {
                assert_eq!(stride as usize, *size);
            }
        }
    }
}
