//! A field with the entry of its key.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Error, Expr, Field, Ident, LitStr, Path, Result, Token, Type};

use crate::options::{docs, meaning, named, names};

/// Where a field comes from.
enum Source {
    /// A key, by an expression of type `&'static Key`.
    Key(TokenStream),
    /// Keys of its own, in the same table; listed by this expression, if there is one.
    Flat(Option<Expr>),
    /// No key.
    None,
}

/// A field of a struct or of a variant.
pub struct Keyed {
    pub member: Ident,
    ty: Type,
    source: Source,
    /// The constant of its key, if it is declared here.
    pub constant: Option<TokenStream>,
    read: Option<Path>,
    /// The type that stands for its own.
    by: Option<Type>,
    is_of_kinds: bool,
    then: Vec<Expr>,
}

/// `#[key(..)]`
struct Entry {
    name: Option<LitStr>,
    constant: Option<Ident>,
    /// An entry that stands elsewhere.
    other: Option<Expr>,
    chain: TokenStream,
}

impl Parse for Entry {
    fn parse(input: ParseStream) -> Result<Self> {
        let mut entry = Self {
            name: None,
            constant: None,
            other: None,
            chain: TokenStream::new(),
        };
        if input.parse::<Option<Token![=]>>()?.is_some() {
            entry.other = Some(input.parse()?);
            return Ok(entry);
        }
        if input.peek(LitStr) {
            entry.name = Some(input.parse()?);
            input.parse::<Token![:]>()?;
        } else if input.peek(Ident) && input.peek2(Token![:]) && !input.peek2(Token![::]) {
            entry.constant = Some(input.parse()?);
            input.parse::<Token![:]>()?;
        }
        entry.chain = input.parse()?;
        Ok(entry)
    }
}

impl Keyed {
    /// Reads the attributes. `owner` has the constants; fields of variants without an entry share one of their name.
    pub fn new(field: &Field, owner: &TokenStream, is_shared: bool) -> Result<Self> {
        let member = match &field.ident {
            Some(member) => member.clone(),
            None => format_ident!("whole"),
        };
        let attributes = &field.attrs;
        let entry = named(attributes, "key").next();
        let entry = entry.map(|attribute| attribute.parse_args::<Entry>());
        let by = named(attributes, "by").next();
        let by = by.map(|attribute| attribute.parse_args::<Type>());
        let by = by.transpose()?;
        let mut constant = None;
        let source = match entry.transpose()? {
            Some(Entry {
                other: Some(other), ..
            }) => Source::Key(quote!(#other)),
            Some(entry) => {
                let (name, declared) =
                    declare(&entry, field, &member, by.as_ref().unwrap_or(&field.ty));
                constant = Some(declared);
                Source::Key(quote!(#owner::#name))
            }
            None if named(attributes, "flat").next().is_some() || field.ident.is_none() => {
                let list = named(attributes, "flat").find(|flat| flat.meta.require_list().is_ok());
                Source::Flat(list.map(|flat| flat.parse_args()).transpose()?)
            }
            None if is_shared => {
                let name = constant_name(&member.to_string());
                Source::Key(quote!(#owner::#name))
            }
            None => Source::None,
        };
        let read = named(attributes, "read").next();
        let read = read.map(|attribute| attribute.parse_args()).transpose()?;
        let parser = Punctuated::<Expr, Token![,]>::parse_terminated;
        let then = named(attributes, "then").next();
        let then = then.map(|attribute| attribute.parse_args_with(parser));
        Ok(Self {
            member,
            ty: field.ty.clone(),
            source,
            constant,
            read,
            by,
            is_of_kinds: named(attributes, "of_kinds").next().is_some(),
            then: then.transpose()?.into_iter().flatten().collect(),
        })
    }

    /// The key of a variant with one field.
    pub fn key(&self) -> Result<&TokenStream> {
        match &self.source {
            Source::Key(key) => Ok(key),
            _ => Err(Error::new(self.member.span(), "needs a `#[key(..)]`")),
        }
    }

    /// Its entries in the list of a table's keys.
    pub fn entries(&self) -> TokenStream {
        let (names, ty) = (names(), &self.ty);
        let own = match &self.source {
            _ if self.is_of_kinds => quote!(),
            Source::Key(key) => quote!(#names::Entry::Key(#key),),
            Source::Flat(Some(list)) => quote!(#names::Entry::All(#list),),
            Source::Flat(None) => quote!(#names::Entry::All(<#ty as Keyed>::KEYS),),
            Source::None => quote!(),
        };
        let then = &self.then;
        quote!(#own #(#names::Entry::Key(#then),)*)
    }

    /// An expression that reads it from `table`.
    pub fn read(&self) -> TokenStream {
        if let (Some(by), Source::Key(key)) = (&self.by, &self.source) {
            return quote!(table.value::<#by>(#key)?.into());
        }
        match (&self.read, &self.source) {
            (Some(read), _) => quote!(#read(table)?),
            (None, Source::Key(key)) => quote!(table.value(#key)?),
            (None, Source::Flat(_)) => quote!(Keyed::read_keys(table)?),
            (None, Source::None) => quote!(Default::default()),
        }
    }

    /// A statement that checks it; `key_path` leads to the table.
    pub fn check(&self, value: &TokenStream) -> TokenStream {
        match &self.source {
            Source::Key(key) => match &self.by {
                Some(by) => quote!(#key.check(key_path, &#by::from(*#value))?;),
                None => quote!(#key.check(key_path, #value)?;),
            },
            Source::Flat(_) => quote!(Keyed::check_keys(#value, key_path)?;),
            Source::None => quote!(),
        }
    }

    /// A statement that writes it into `map`.
    pub fn write(&self, value: &TokenStream) -> TokenStream {
        match &self.source {
            Source::Key(key) => match &self.by {
                Some(by) => quote!(#key.write(&#by::from(*#value), map)?;),
                None => quote!(#key.write(#value, map)?;),
            },
            Source::Flat(_) => quote!(Keyed::write_keys(#value, map)?;),
            Source::None => quote!(),
        }
    }

    /// A statement that shows it in `panel`.
    pub fn row(&self, value: &TokenStream) -> TokenStream {
        match &self.source {
            Source::Key(key) => quote!(#key.row(#value, panel);),
            Source::Flat(_) => quote!(Rows::rows(#value, panel);),
            Source::None => quote!(),
        }
    }

    /// Its initial value.
    pub fn initial(&self) -> TokenStream {
        match &self.source {
            Source::Key(key) => quote!(#key.initial()),
            Source::Flat(_) | Source::None => quote!(Default::default()),
        }
    }
}

/// The constant of a key and its declaration.
fn declare(entry: &Entry, field: &Field, member: &Ident, ty: &Type) -> (Ident, TokenStream) {
    let name = match &entry.name {
        Some(name) => name.value(),
        None => member.to_string(),
    };
    let constant = match &entry.constant {
        Some(constant) => constant.clone(),
        None => constant_name(&name),
    };
    let (docs, meaning) = (docs(&field.attrs), meaning(&field.attrs));
    let chain = &entry.chain;
    let chain = match chain.is_empty() {
        true => quote!(),
        false => quote!(.#chain),
    };
    let names = names();
    let declared = quote! {
        #(#docs)*
        pub const #constant: &'static #names::Key = {
            #[allow(unused_imports)]
            use #names::*;
            &Key::new(#name, <#ty as KeyValue>::FORM).means(#meaning)#chain
        };
    };
    (constant, declared)
}

fn constant_name(name: &str) -> Ident {
    format_ident!("{}", name.to_uppercase())
}
