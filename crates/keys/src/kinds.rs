//! Enums whose variant is told by the value of a tag.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DataEnum, DeriveInput, Error, Fields, LitStr, Result, Variant};

use crate::field::Keyed;
use crate::options::{Options, kind, meaning, names};

/// A variant with its fields.
struct Case<'v> {
    variant: &'v Variant,
    name: LitStr,
    fields: Vec<Keyed>,
}

impl<'v> Case<'v> {
    fn new(variant: &'v Variant, owner: &TokenStream) -> Result<Self> {
        let name = kind(&variant.attrs)?;
        let missing = || Error::new_spanned(variant, "needs a `#[kind(\"name\")]`");
        let fields = variant.fields.iter();
        let fields = fields.map(|field| Keyed::new(field, owner, true));
        Ok(Self {
            variant,
            name: name.ok_or_else(missing)?,
            fields: fields.collect::<Result<_>>()?,
        })
    }

    fn choice(&self) -> TokenStream {
        let (name, meaning) = (&self.name, meaning(&self.variant.attrs));
        let entries = self.fields.iter().map(Keyed::entries);
        quote! {
            Choice::new(#name, #meaning, &[#(#entries)*])
        }
    }

    fn read(&self) -> TokenStream {
        let ident = &self.variant.ident;
        let members = self.fields.iter().map(|field| &field.member);
        let values = self.fields.iter().map(Keyed::read);
        match &self.variant.fields {
            Fields::Unit => quote!(Self::#ident),
            Fields::Named(_) => quote!(Self::#ident { #(#members: #values),* }),
            Fields::Unnamed(_) => quote!(Self::#ident(#(#values),*)),
        }
    }

    fn pattern(&self) -> TokenStream {
        let ident = &self.variant.ident;
        let members = self.fields.iter().map(|field| &field.member);
        match &self.variant.fields {
            Fields::Unit => quote!(Self::#ident),
            Fields::Named(_) => quote!(Self::#ident { #(#members),* }),
            Fields::Unnamed(_) => quote!(Self::#ident(#(#members),*)),
        }
    }

    /// An arm that does something with each field.
    fn arm(&self, each: impl Fn(&Keyed, &TokenStream) -> TokenStream) -> TokenStream {
        let pattern = self.pattern();
        let statements = self.fields.iter().map(|field| {
            let member = &field.member;
            each(field, &quote!(#member))
        });
        quote!(#pattern => { #(#statements)* })
    }
}

pub fn expand(input: &DeriveInput, options: &Options, data: &DataEnum) -> Result<TokenStream> {
    let owner = &input.ident;
    let path = quote!(#owner);
    let cases = data
        .variants
        .iter()
        .map(|variant| Case::new(variant, &path));
    let cases = cases.collect::<Result<Vec<_>>>()?;
    let [others @ .., last] = &cases[..] else {
        return Err(Error::new_spanned(input, "needs a variant"));
    };
    let constants = cases.iter().flat_map(|case| &case.fields);
    let constants = constants.filter_map(|field| field.constant.as_ref());
    let choices = cases.iter().map(Case::choice);
    let names = names();
    let tag = options.tag.iter();
    let tag = quote!(#(#tag)*);
    let write_tag = options.tag.as_ref().filter(|tag| !tag.value().is_empty());
    let write_tag = write_tag.map(|tag| quote!(map.serialize_entry(#tag, self.name())?;));
    let tags: Vec<_> = cases.iter().map(|case| &case.name).collect();
    let idents = cases.iter().map(|case| &case.variant.ident);
    let (other_names, other_reads) = (
        others.iter().map(|case| &case.name),
        others.iter().map(Case::read),
    );
    let last_read = last.read();
    let checks = cases.iter().map(|case| case.arm(Keyed::check));
    let writes = cases.iter().map(|case| case.arm(Keyed::write));
    let rows = cases.iter().map(|case| case.arm(Keyed::row));
    let check_more = options.check_more();
    Ok(quote! {
        impl #owner {
            #(#constants)*

            /// Its value of the tag in a file.
            pub fn name(&self) -> &'static str {
                match self {
                    #(Self::#idents { .. } => #tags,)*
                }
            }
        }

        const _: () = {
            use #names::*;

            impl Kinds for #owner {
                const TAG: &'static str = #tag;
                const CHOICES: &'static [Choice] = &[#(#choices),*];
            }

            impl Keyed for #owner {
                const KEYS: &'static [Entry] = &[];

                fn read_keys(table: &Table) -> Result<Self, Error> {
                    Ok(match table.kind() {
                        #(#other_names => #other_reads,)*
                        _ => #last_read,
                    })
                }

                fn check_keys(&self, key_path: &str) -> Check {
                    match self {
                        #(#checks)*
                    }
                    #check_more
                }

                fn write_keys<M: serde::ser::SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
                    #write_tag
                    match self {
                        #(#writes)*
                    }
                    Ok(())
                }
            }

            impl Rows for #owner {
                fn rows(&mut self, panel: &mut dyn Panel) {
                    match self {
                        #(#rows)*
                    }
                }
            }
        };
    })
}
