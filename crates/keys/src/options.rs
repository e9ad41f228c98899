//! Attributes of types and of variants.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, Expr, Ident, LitStr, Path, Result};

/// What `#[keyed(..)]` says of a type.
#[derive(Default)]
pub struct Options {
    pub is_table: bool,
    pub has_own_reader: bool,
    pub has_default: bool,
    pub is_one_of: bool,
    pub kinds: Option<Ident>,
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

/// What `#[kind(..)]` says of a variant.
pub struct Kind {
    /// Value of the tag.
    pub name: LitStr,
    /// Further keys that belong to it, listed before its fields: an expression of type `&'static [Entry]`.
    pub before: Option<Expr>,
    /// Those listed after its fields.
    pub after: Option<Expr>,
}

impl Kind {
    pub fn of_variant(attributes: &[Attribute]) -> Result<Option<Self>> {
        let Some(attribute) = named(attributes, "kind").next() else {
            return Ok(None);
        };
        attribute
            .parse_args_with(|input: syn::parse::ParseStream| {
                let mut kind = Self {
                    name: input.parse()?,
                    before: None,
                    after: None,
                };
                while input.parse::<Option<syn::Token![,]>>()?.is_some() {
                    let word: Ident = input.parse()?;
                    input.parse::<syn::Token![=]>()?;
                    let keys = Some(input.parse()?);
                    match word.to_string().as_str() {
                        "before" => kind.before = keys,
                        "after" => kind.after = keys,
                        _ => {
                            return Err(syn::Error::new(
                                word.span(),
                                "must be `before` or `after`",
                            ));
                        }
                    }
                }
                Ok(kind)
            })
            .map(Some)
    }
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
