//! Attributes of types and of variants.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Attribute, Expr, Ident, LitStr, Path, Result};

/// What `#[keyed(..)]` says of a type.
#[derive(Default)]
pub struct Options {
    pub is_table: bool,
    pub has_own_reader: bool,
    pub has_default: bool,
    pub is_one_of: bool,
    pub kinds: Option<Ident>,
    pub of_kinds: Option<Path>,
    pub check: Option<Path>,
    pub remote: Option<Path>,
    pub tag: Option<LitStr>,
}

impl Options {
    pub fn of_type(attributes: &[Attribute]) -> Result<Self> {
        let mut options = Self::default();
        for attribute in named(attributes, "keyed") {
            attribute.parse_nested_meta(|meta| {
                let path = &meta.path;
                let is = |name: &str| path.is_ident(name);
                if is("table") {
                    options.is_table = true;
                } else if is("own_reader") {
                    options.has_own_reader = true;
                } else if is("default") {
                    options.has_default = true;
                } else if is("one_of") {
                    options.is_one_of = true;
                } else if is("kinds") {
                    options.kinds = Some(meta.value()?.parse()?);
                } else if is("of_kinds") {
                    options.of_kinds = Some(meta.value()?.parse()?);
                } else if is("check") {
                    options.check = Some(meta.value()?.parse()?);
                } else if is("remote") {
                    options.remote = Some(meta.value()?.parse()?);
                } else if is("tag") {
                    options.tag = Some(meta.value()?.parse()?);
                } else {
                    return Err(meta.error("unknown option of `keyed`"));
                }
                Ok(())
            })?;
        }
        Ok(options)
    }

    /// The call of the checks that are written by hand.
    pub fn check_more(&self) -> TokenStream {
        let check = self.check.as_ref();
        check.map_or_else(|| quote!(Ok(())), |check| quote!(#check(self, key_path)))
    }
}

/// The value of the tag that `#[kind("name")]` gives a variant.
pub fn kind(attributes: &[Attribute]) -> Result<Option<LitStr>> {
    let kind = named(attributes, "kind").next();
    kind.map(|attribute| attribute.parse_args()).transpose()
}

/// The module of `hairline-document` that has all names of what is made.
pub fn names() -> TokenStream {
    // Not a path of this crate.
    let root = format_ident!("crate");
    quote!(#root::description::derived)
}

/// The attributes of this name.
pub fn named<'a>(
    attributes: &'a [Attribute],
    name: &'a str,
) -> impl Iterator<Item = &'a Attribute> {
    attributes
        .iter()
        .filter(move |attribute| attribute.path().is_ident(name))
}

/// Lines of documentation.
pub fn docs(attributes: &[Attribute]) -> Vec<&Attribute> {
    named(attributes, "doc").collect()
}

/// The documentation as one text.
pub fn meaning(attributes: &[Attribute]) -> String {
    let lines = named(attributes, "doc").filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                syn::Lit::Str(text) => Some(text.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join(" ")
}
