//! Enums of keys that exclude one another: the key that is there tells the variant.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DataEnum, DeriveInput, Error, Field, Fields, Ident, Result, Variant};

use crate::field::Keyed;
use crate::options::{Options, names};

pub fn expand(input: &DeriveInput, options: &Options, data: &DataEnum) -> Result<TokenStream> {
    let owner = &input.ident;
    let variants = data.variants.iter().map(only_field);
    let variants = variants.collect::<Result<Vec<(Ident, Field)>>>()?;
    let fields = variants
        .iter()
        .map(|(_, field)| Keyed::new(field, &quote!(#owner), false));
    let fields = fields.collect::<Result<Vec<_>>>()?;
    let idents: Vec<_> = variants.iter().map(|(ident, _)| ident).collect();
    let keys = fields.iter().map(Keyed::key);
    let keys = keys.collect::<Result<Vec<_>>>()?;
    let constants = fields.iter().filter_map(|field| field.constant.as_ref());
    let entries = fields.iter().map(Keyed::entries);
    let ([others @ .., last], [other_keys @ .., last_key]) = (&idents[..], &keys[..]) else {
        return Err(Error::new_spanned(input, "needs a variant"));
    };
    let names = names();
    // It says more than the bounds of a key.
    let check_first = options.check.iter();
    Ok(quote! {
        impl #owner {
            #(#constants)*
        }

        const _: () = {
            use #names::*;

            impl Keyed for #owner {
                const KEYS: &'static [Entry] = &[#(#entries)*];

                fn read_keys(table: &Table) -> Result<Self, Error> {
                    let found = table.one_of(&[#(#keys.name),*])?;
                    #(if found == #other_keys.name {
                        return table.required(found).map(Self::#others);
                    })*
                    table.required(#last_key.name).map(Self::#last)
                }

                fn check_keys(&self, key_path: &str) -> Check {
                    #(#check_first(self, key_path)?;)*
                    match self {
                        #(Self::#idents(value) => #keys.check(key_path, value),)*
                    }
                }

                fn write_keys<M: serde::ser::SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
                    match self {
                        #(Self::#idents(value) => #keys.write(value, map),)*
                    }
                }
            }

            impl Rows for #owner {
                fn rows(&mut self, panel: &mut dyn Panel) {
                    match self {
                        #(Self::#idents(value) => #keys.row(value, panel),)*
                    }
                }
            }
        };
    })
}

/// The field of a variant, with the attributes of the variant.
fn only_field(variant: &Variant) -> Result<(Ident, Field)> {
    let wrong = || Error::new_spanned(variant, "must have one field without a name");
    let Fields::Unnamed(fields) = &variant.fields else {
        return Err(wrong());
    };
    let field = fields.unnamed.first().ok_or_else(wrong)?;
    let field = Field {
        attrs: variant.attrs.clone(),
        ..field.clone()
    };
    Ok((variant.ident.clone(), field))
}
